"""The loop transfer function and what is read from it: stability, margins, sensitivities, gaps."""
