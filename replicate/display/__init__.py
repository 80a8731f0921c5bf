"""What report, handout, diff and terminal share: numbers, labels, tables and texts as a reader sees them."""
