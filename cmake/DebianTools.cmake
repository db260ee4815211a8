# Run by cpack before it packs. Without dpkg-shlibdeps it would make packages that depend on nothing, and not fail.

if(CPACK_GENERATOR STREQUAL DEB)
  find_program(DPKG_SHLIBDEPS dpkg-shlibdeps)
  find_program(FILE_PROGRAM file)
  if(NOT DPKG_SHLIBDEPS OR NOT FILE_PROGRAM)
    message(FATAL_ERROR "Debian packages are made with dpkg-shlibdeps and file: apt-get install dpkg-dev file")
  endif()
endif()
