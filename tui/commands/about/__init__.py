"""Lists and help: `scenes`, `methods`, `doctor`."""
