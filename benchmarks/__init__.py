"""Speed and error of the numerical core, measured beside other tools."""
