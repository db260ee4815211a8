"""Loaded by every Python that the tests start.

meshio reads a .vtu file's arrays one behind the other out of one text, and
counts on base64.b64decode to stop at the padding of each. The Python of
Debian 13 decodes beyond it, and fails.
"""
import base64

whole = base64.b64decode


def until_padding(data, *arguments, **options):
    sign = "=" if isinstance(data, str) else b"="
    end = data.find(sign)
    if end >= 0:
        data = data[:end + (2 if data[end + 1:end + 2] == sign else 1)]
    return whole(data, *arguments, **options)


base64.b64decode = until_padding
