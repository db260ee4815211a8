# Man pages (help2man, from --help and docs/man/<tool>.h2m) and completion for bash and zsh (from --help), made with the
# tools and installed beside them. Without help2man there are no man pages of the tools.
find_program(HELP2MAN help2man)
find_program(GZIP gzip REQUIRED)
option(HEXPIPE_MANUAL "Make man pages and shell completion by running the tools" ON)

# The date of the pages is that of the version, so that it does not differ from build to build.
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  set(HEXPIPE_EPOCH "$ENV{SOURCE_DATE_EPOCH}")
else()
  execute_process(COMMAND date -u -d "${HEXPIPE_DATE}" +%s OUTPUT_VARIABLE HEXPIPE_EPOCH OUTPUT_STRIP_TRAILING_WHITESPACE
    COMMAND_ERROR_IS_FATAL ANY)
endif()

# hexpipe_install_page(PAGE SECTION COMPONENT): PAGE.gz beside it, without the time at which it is made.
function(hexpipe_install_page page section component)
  add_custom_command(OUTPUT "${page}.gz" COMMAND "${GZIP}" -9 -n -k -f "${page}" DEPENDS "${page}" VERBATIM)
  install(FILES "${page}.gz" DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} COMPONENT ${component})
endfunction()

# hexpipe_manual(TOOL COMPONENT)
function(hexpipe_manual tool component)
  if(NOT HEXPIPE_MANUAL OR CMAKE_CROSSCOMPILING)
    return()
  endif()
  set(folder "${CMAKE_BINARY_DIR}/manual")
  set(outputs "${folder}/bash/${tool}" "${folder}/zsh/_${tool}")
  add_custom_command(OUTPUT ${outputs}
    COMMAND ${CMAKE_COMMAND} "-DTOOL=$<TARGET_FILE:${tool}>" "-DBASH=${folder}/bash/${tool}" "-DZSH=${folder}/zsh/_${tool}"
      -P "${PROJECT_SOURCE_DIR}/cmake/Completion.cmake"
    DEPENDS ${tool} "${PROJECT_SOURCE_DIR}/cmake/Completion.cmake" VERBATIM)
  install(FILES "${folder}/bash/${tool}" DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    COMPONENT ${component})
  install(FILES "${folder}/zsh/_${tool}" DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT ${component})
  if(HELP2MAN)
    set(page "${folder}/man/${tool}.1")
    set(extra "${PROJECT_SOURCE_DIR}/docs/man/${tool}.h2m")
    # help2man gives the name of the executable to a shell: there is no blank in one that is looked for beside it.
    add_custom_command(OUTPUT "${page}"
      COMMAND ${CMAKE_COMMAND} -E make_directory "${folder}/man"
      COMMAND ${CMAKE_COMMAND} -E env SOURCE_DATE_EPOCH=${HEXPIPE_EPOCH} ${HELP2MAN} --no-info --no-discard-stderr --section=1
        "--source=hexpipe ${PROJECT_VERSION}" "--include=${extra}" "--output=${page}" "./$<TARGET_FILE_NAME:${tool}>"
      WORKING_DIRECTORY "$<TARGET_FILE_DIR:${tool}>"
      DEPENDS ${tool} "${extra}" VERBATIM)
    list(APPEND outputs "${page}" "${page}.gz")
    hexpipe_install_page("${page}" 1 ${component})
  endif()
  add_custom_target(${tool}_manual ALL DEPENDS ${outputs})
endfunction()
