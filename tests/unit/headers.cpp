// Nothing but the precompiled header that the unit tests share.
