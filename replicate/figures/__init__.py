"""Draw figures off-screen, read back what they show, and compare two of them; knows no paper."""
