# Debian packages by `cpack -G DEB`. Components are declared where their targets are installed.
