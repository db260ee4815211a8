# `cmake --build build --target lint`: clang-tidy over every source of the tools and libraries, as .clang-tidy says.

find_program(RUN_CLANG_TIDY NAMES run-clang-tidy run-clang-tidy-14)
if(RUN_CLANG_TIDY)
  add_custom_target(lint
    COMMAND ${RUN_CLANG_TIDY} -quiet -p "${CMAKE_BINARY_DIR}" "^${PROJECT_SOURCE_DIR}/(common|formats|tools)/"
    USES_TERMINAL VERBATIM)
endif()
