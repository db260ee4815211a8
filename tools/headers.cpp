// Nothing but the precompiled header that the tools' main.cpp share.
