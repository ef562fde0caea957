// Nothing: CMake needs a source file to make a precompiled header.
