"""Where solving runs: commands, the loop, the child process and the thread that owns it."""
