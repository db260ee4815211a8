# Run by cpack between installing and packing. Debian's zsh looks for the completions of packages in vendor-completions, and
# not in site-functions, which is for what is built on the machine.

file(GLOB folders "${CPACK_TEMPORARY_DIRECTORY}/*/usr/share/zsh")
foreach(folder IN LISTS folders)
  if(EXISTS "${folder}/site-functions")
    file(RENAME "${folder}/site-functions" "${folder}/vendor-completions")
  endif()
endforeach()
