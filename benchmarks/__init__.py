"""What the numerical core costs beside other tools, and how exact each is: `python -m benchmarks`."""

import os

# Before numpy is imported anywhere: it reads these once. Threads that wait for each other count as processor time.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"):
    os.environ.setdefault(_variable, "1")
