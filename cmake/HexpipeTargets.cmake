# Warnings, sanitizers and the two kinds of target that every directory declares.

add_library(hexpipe_flags INTERFACE)
target_compile_options(hexpipe_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wcast-align
  # No fused multiply-add: the same input gives the same bytes on every machine.
  -ffp-contract=off
  # No code reads errno after a mathematical function: without it a square root is one instruction, and several can be
  # taken at once.
  -fno-math-errno
  # The standard library of g++ 12 itself calls what C++20 has deprecated, and clang++ tells of it.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>)
if(HEXPIPE_WERROR)
  target_compile_options(hexpipe_flags INTERFACE -Werror)
endif()
if(HEXPIPE_SANITIZE)
  target_compile_options(hexpipe_flags INTERFACE
    -fsanitize=${HEXPIPE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -D_GLIBCXX_ASSERTIONS
    # The sanitizers' instructions make g++ see uses of uninitialized values where there are none (in OpenMesh).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  if(HEXPIPE_SANITIZE MATCHES address)
    # By this name g++ tells the code of the sanitizer, and clang++ from version 21 on.
    target_compile_definitions(hexpipe_flags INTERFACE $<$<CXX_COMPILER_ID:Clang>:__SANITIZE_ADDRESS__>)
  endif()
  if(NOT HEXPIPE_FUZZ)
    # Left to the fuzzers, for everything compiles a third faster: accesses by null and beyond objects end in the address
    # sanitizer anyway.
    target_compile_options(hexpipe_flags INTERFACE -fno-sanitize=null,vptr,object-size,pointer-overflow)
    # The sanitizers' tables have 600,000 addresses, which the loader would have to fill in at every start of a tool.
    # Modules, which tools load, stay independent of their place.
    set(is_module $<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>)
    target_compile_options(hexpipe_flags INTERFACE $<$<NOT:${is_module}>:-fno-pie>)
    target_link_options(hexpipe_flags INTERFACE $<$<NOT:${is_module}>:-no-pie>)
  endif()
  target_link_options(hexpipe_flags INTERFACE -fsanitize=${HEXPIPE_SANITIZE})
endif()

if(HEXPIPE_UNITY)
  # Between the files of one unit there is nothing to see: the other builds compile each by itself and look.
  target_compile_options(hexpipe_flags INTERFACE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  # g++ looks for memory that it can use again only from this many kB on, not from 128 MB on, which is a tenth of its time.
  target_compile_options(hexpipe_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
endif()

# What takes options apart has nothing to be fast at, and takes a third less time to compile so, without optimization
# half. Tests are compiled without optimization everywhere.
set(HEXPIPE_QUICK_COMPILE -O1)
if((HEXPIPE_SANITIZE AND NOT HEXPIPE_FUZZ) OR HEXPIPE_UNITY)
  set(HEXPIPE_QUICK_COMPILE -O0)
endif()

# hexpipe_library(NAME SOURCES... [LINK LIBS...])
# With HEXPIPE_UNITY, files of one namespace share their anonymous namespaces: names there differ within a room.
function(hexpipe_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${arg_SOURCES})
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PUBLIC hexpipe_flags ${arg_LINK})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${HEXPIPE_UNITY} UNITY_BUILD_BATCH_SIZE 20)
  if(HEXPIPE_UNITY)
    target_precompile_headers(${name} REUSE_FROM library_headers)
  endif()
endfunction()

# hexpipe_cold(LIBRARY): one in which tests spend little of their time. With HEXPIPE_UNITY it is optimized less, which
# saves more than it costs.
function(hexpipe_cold library)
  if(HEXPIPE_UNITY AND HEXPIPE_SANITIZE)
    target_compile_options(${library} PRIVATE -O0)
    # clang++ takes a precompiled header for its own degree of optimization alone.
    set_target_properties(${library} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
  elseif(HEXPIPE_UNITY)
    target_compile_options(${library} PRIVATE -O1)
  endif()
endfunction()

# hexpipe_copyright(COMPONENT): the file that Debian expects in each package, made of LICENSE.
function(hexpipe_copyright component)
  file(READ "${PROJECT_SOURCE_DIR}/LICENSE" license)
  string(REGEX MATCH "Copyright \\(c\\) ([^\n]*)\n\n(.*)\n\n-----*\n\n(.*)" matched "${license}")
  set(holders "${CMAKE_MATCH_1}")
  set(terms "${CMAKE_MATCH_2}")
  set(notes "${CMAKE_MATCH_3}")
  foreach(text terms notes)
    string(STRIP "${${text}}" ${text})
    string(REPLACE "\n\n" "\n.\n" ${text} "${${text}}")
    string(REPLACE "\n" "\n " ${text} "${${text}}")
  endforeach()
  set(page "${CMAKE_BINARY_DIR}/copyright/${component}")
  file(WRITE "${page}" "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: hexpipe

Files: *
Copyright: ${holders}
License: Expat
Comment:
 ${notes}

License: Expat
 ${terms}
")
  install(FILES "${page}" RENAME copyright COMPONENT ${component} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${component})
endfunction()

# hexpipe_tool(NAME [COMPONENT PACKAGE] [SOURCES...] [LINK LIBS...]): library NAME_core with the algorithms, executable
# NAME from main.cpp, installed with the others or as a package of its own.
# Without sources main.cpp is all of the tool.
function(hexpipe_tool name)
  cmake_parse_arguments(arg "" "COMPONENT" "SOURCES;LINK" ${ARGN})
  add_executable(${name} main.cpp)
  target_compile_options(${name} PRIVATE ${HEXPIPE_QUICK_COMPILE})
  target_precompile_headers(${name} REUSE_FROM tool_headers)
  if(arg_SOURCES)
    hexpipe_library(${name}_core SOURCES ${arg_SOURCES} LINK ${arg_LINK})
    target_link_libraries(${name} PRIVATE ${name}_core)
  endif()
  target_link_libraries(${name} PRIVATE hexpipe_formats hexpipe_common)
  if(arg_COMPONENT)
    # What is given out apart has its licences with it.
    install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/THIRD-PARTY.md" COMPONENT ${arg_COMPONENT}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${arg_COMPONENT})
    hexpipe_copyright(${arg_COMPONENT})
  else()
    set(arg_COMPONENT hexpipe)
  endif()
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${arg_COMPONENT})
  hexpipe_manual(${name} ${arg_COMPONENT})
endfunction()
