"""change_array.py BUNDLE CHANGED MEMBER EXPRESSION - copies a bundle with one array changed: what the Python EXPRESSION makes
of it, which calls it `a`.
"""
import io
import sys
import tarfile

import numpy as np

source, target, name, expression = sys.argv[1:]
found = False
with tarfile.open(source) as old, tarfile.open(target, "w", format=tarfile.PAX_FORMAT) as new:
    for member in old:
        data = old.extractfile(member).read()
        if member.name == name:
            a = np.load(io.BytesIO(data))
            changed = io.BytesIO()
            np.save(changed, np.asarray(eval(expression)))
            data = changed.getvalue()
            member.size = len(data)
            found = True
        new.addfile(member, io.BytesIO(data))
if not found:
    sys.exit(f"{source} has no {name}")
