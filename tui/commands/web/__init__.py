"""The lab in a browser: `server` starts a process for each tab."""
