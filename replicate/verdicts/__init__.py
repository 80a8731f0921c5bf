"""Judge what a run computed against what the paper prints, and explain what does not hold."""
