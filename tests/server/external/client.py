"""tests/server/external/client.py ADDRESS: connects by itself and drives slowly on."""
import sys

import tautline

tautline.drive(lambda seen: (0.2, 0.0), address=sys.argv[1])
