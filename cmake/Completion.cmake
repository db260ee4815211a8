# Run as a script: cmake -DTOOL=executable -DBASH=file -DZSH=file -P Completion.cmake
# Writes completion of the tool's options, read from its --help: names, what follows them, and what they do.

get_filename_component(tool "${TOOL}" NAME)
execute_process(COMMAND "${TOOL}" --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)

# The formats depend on what the tool writes: its message about one that is not there lists them.
set(formats "")
if(help MATCHES "\n  --format ")
  execute_process(COMMAND "${TOOL}" --format "?" INPUT_FILE /dev/null ERROR_VARIABLE message OUTPUT_QUIET)
  if(message MATCHES " as (.*) or (tar, tar.zst), found ")
    string(REPLACE "," "" formats "${CMAKE_MATCH_1} ${CMAKE_MATCH_2}")
  endif()
endif()

# Brackets and semicolons mean something in lists; what is between them is kept by other signs.
string(REPLACE ";" "," help "${help}")
string(REPLACE "[" "(" help "${help}")
string(REPLACE "]" ")" help "${help}")
string(REGEX REPLACE "({[^}\n]*,)\n +" "\\1" help "${help}")
string(REGEX REPLACE "\n                            +" " " help "${help}")
string(REPLACE "\n" ";" lines "${help}")

set(words "")
set(functions "")
set(cases "")
set(arguments "")
foreach(line IN LISTS lines)
  if(NOT line MATCHES "^  (-[a-zA-Z])?,?(--[a-z0-9-]+)( (\\(?[A-Z][^ ]*))?(.*)$")
    continue()
  endif()
  set(short "${CMAKE_MATCH_1}")
  set(long "${CMAKE_MATCH_2}")
  set(type "${CMAKE_MATCH_4}")
  string(STRIP "${CMAKE_MATCH_5}" text)
  string(APPEND words " ${long}")

  # What zsh shows: no colons, quotes or what belongs to the type.
  string(REGEX REPLACE "^in \\([^)]*\\)[^ ]* *" "" text "${text}")
  string(REGEX REPLACE "^(=[^ ]*|\\.\\.\\.) *" "" text "${text}")
  string(REGEX REPLACE "^(x [0-9]+|REQUIRED) *" "" text "${text}")
  string(REGEX REPLACE "(Needs|Excludes): (--[a-z-]+ *)+" "" text "${text}")
  string(REPLACE "'" "" text "${text}")
  string(REPLACE ":" "," text "${text}")
  set(names "${long}")
  if(short)
    set(names "${short},${long}")
    set(spec "'(${short} ${long})'{${short},${long}}'[${text}]")
    string(REPLACE "," "|" pattern "${names}")
  else()
    set(spec "'${long}[${text}]")
    set(pattern "${long}")
  endif()

  set(choices "")
  if(type MATCHES "{([^}]*)}")
    string(REPLACE "," " " choices "${CMAKE_MATCH_1}")
  elseif(long STREQUAL "--format")
    set(choices "${formats}")
  endif()
  if(choices AND type MATCHES "[|]FILE")
    string(APPEND cases "    ${pattern}) COMPREPLY=(\$(compgen -W \"${choices}\" -f -- \"\$current\")); return ;;\n")
    string(MAKE_C_IDENTIFIER "_hexpipe_${tool}${long}" function)
    string(APPEND functions "${function}() {
  _alternative 'values:value:(${choices})' 'files:file:_files'
}
")
    string(APPEND spec ":value or file:${function}")
  elseif(choices AND text MATCHES "separated by commas")
    # The values before the last comma stay.
    string(APPEND cases "    ${pattern})
      local before=''
      if [[ \$current == *,* ]]; then before=\${current%,*},; fi
      COMPREPLY=(\$(compgen -P \"\$before\" -W \"${choices}\" -- \"\${current##*,}\")); return ;;\n")
    string(APPEND spec ":values:_values -s , value ${choices}")
  elseif(choices)
    string(APPEND cases "    ${pattern}) COMPREPLY=(\$(compgen -W \"${choices}\" -- \"\$current\")); return ;;\n")
    string(APPEND spec ":value:(${choices})")
  elseif(type MATCHES "^FILE|[|]FILE")
    string(APPEND cases "    ${pattern}) COMPREPLY=(\$(compgen -f -- \"\$current\")); return ;;\n")
    string(APPEND spec ":file:_files")
  elseif(type MATCHES "^(DIR|FOLDER)")
    string(APPEND cases "    ${pattern}) COMPREPLY=(\$(compgen -d -- \"\$current\")); return ;;\n")
    string(APPEND spec ":directory:_files -/")
  elseif(type MATCHES "^\\(")
    # A value that may be left out: a file or an option may follow as well.
    string(APPEND spec "::value: ")
  elseif(NOT type STREQUAL "") # not elseif(type): a value called N is false to CMake
    string(APPEND cases "    ${pattern}) return ;;\n")
    string(APPEND spec ":value: ")
  endif()
  string(APPEND arguments "  ${spec}' \\\n")
endforeach()

file(WRITE "${BASH}" "# Completion of ${tool}'s options; made from its --help.
_hexpipe_${tool}() {
  local current=\${COMP_WORDS[COMP_CWORD]} previous=\${COMP_WORDS[COMP_CWORD - 1]}
  COMPREPLY=()
  case \$previous in
${cases}  esac
  if [[ \$current == -* ]]; then
    COMPREPLY=(\$(compgen -W \"${words}\" -- \"\$current\"))
  else
    COMPREPLY=(\$(compgen -f -- \"\$current\"))
  fi
}
complete -o filenames -F _hexpipe_${tool} ${tool}
")
file(WRITE "${ZSH}" "#compdef ${tool}
# Completion of ${tool}'s options; made from its --help.
${functions}_arguments -s \\
${arguments}  '*:file:_files'
")
