"""What happened, told once: bars over the views, a list of all of it, a file for the day after."""
