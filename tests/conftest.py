"""What all tests have in common."""

import os

# As the command does it: threads of the linear algebra would wait for one another on a busy machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
