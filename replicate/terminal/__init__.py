"""What the command line shows: progress, summaries, and single exhibits."""
