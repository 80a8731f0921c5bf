"""What a plant may be: a sum with dead times, a function of s, a model of python-control."""
