"""How views are arranged and what each shows, as plain values: for session files and for the next start."""
