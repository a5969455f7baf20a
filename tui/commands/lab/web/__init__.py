"""The lab in a browser: `server` listens and starts a process for each tab, in which `served` shows a lab that can
neither read nor write a file by name; `page` is what the browser loads first."""
