"""Controllers with the largest integral gain whose sensitivity stays below a bound."""
