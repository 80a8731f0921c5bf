"""Find the papers, compute their exhibits in parallel processes, keep results between runs."""
