# Run as a script: cmake -DOUTPUT=x.cpp -DHEADER=h.hpp -DNAMESPACE=n "-DFILES=name=path;..." -P EmbedFiles.cmake
# Writes a source that defines each name as a std::string_view of its file. A literal may hold 64 KiB at least, so it is
# written in pieces.

set(source "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n\n")
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]+)=(.*)$" matched "${entry}")
  set(name "${CMAKE_MATCH_1}")
  file(READ "${CMAKE_MATCH_2}" bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
  # Each byte is four characters; pieces of 4000 bytes on lines of their own, which the compiler joins.
  string(LENGTH "${bytes}" length)
  set(literal "")
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${bytes}" ${at} 16000 piece)
    string(APPEND literal "\n    \"${piece}\"")
    math(EXPR at "${at} + 16000")
  endwhile()
  math(EXPR size "${length} / 4")
  string(APPEND source "const std::string_view ${name}(${literal},\n    ${size});\n\n")
endforeach()
string(APPEND source "}  // namespace ${NAMESPACE}\n")
file(WRITE "${OUTPUT}" "${source}")
