// Nothing but the precompiled header that the libraries share.
