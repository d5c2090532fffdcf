# libpalpate_core and libpalpate_client, static and shared, from the objects that the build has anyway: they are
# position independent, so that nothing is compiled twice. The shared ones show only what their doors declare.

# Before 1.0 a minor version may change the binary interface.
set(palpate_soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

# palpate_headers_behind(<out> <header>...): the headers, and those of ours that they include.
function(palpate_headers_behind out)
  set(waiting ${ARGN})
  set(found)
  while(waiting)
    list(POP_FRONT waiting header)
    if(NOT header IN_LIST found)
      list(APPEND found ${header})
      file(STRINGS ${PROJECT_SOURCE_DIR}/${header} includes REGEX "^#include \"(core|node)/")
      list(TRANSFORM includes REPLACE "^#include \"([^\"]+)\".*" "\\1")
      list(APPEND waiting ${includes})
    endif()
  endwhile()
  list(SORT found)
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# palpate_version_script(<file> <set> NAMESPACES ... HEADERS ... [ALSO <pattern>...]): a linker's version script that
# keeps what the headers declare, functions and members of classes, and hides all else.
function(palpate_version_script file set)
  cmake_parse_arguments(ARG "" "" "NAMESPACES;HEADERS;ALSO" ${ARGN})
  set(end "[!a-zA-Z_0-9::]*")
  set(patterns ${ARG_ALSO})
  foreach(header IN LISTS ARG_HEADERS)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
    file(READ ${PROJECT_SOURCE_DIR}/${header} text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REGEX MATCHALL "[A-Za-z_][A-Za-z_0-9]*\\(" functions "${text}")
    list(TRANSFORM functions REPLACE "\\($" "")
    string(REGEX MATCHALL "(class|struct) [A-Za-z_0-9]+" classes "${text}")
    list(TRANSFORM classes REPLACE "^(class|struct) " "")
    foreach(namespace IN LISTS ARG_NAMESPACES)
      foreach(name IN LISTS functions)
        list(APPEND patterns ${namespace}::${name}${end})
      endforeach()
      foreach(class IN LISTS classes)
        set(scope ${namespace}::${class})
        list(APPEND patterns "* for ${scope}" ${scope}::?${class}${end} ${scope}::operator${end})
        foreach(name IN LISTS functions ITEMS ${class})
          list(APPEND patterns ${scope}::${name}${end})
        endforeach()
      endforeach()
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES patterns)
  list(SORT patterns)
  string(TOUPPER ${set} node)
  list(TRANSFORM patterns APPEND "@")
  list(JOIN patterns "\n    " text)
  # In quotes a name would be meant to the letter; without them a blank ends it: "?" stands for it, and for a tilde.
  string(REPLACE " for " "?for?" text "${text}")
  string(REPLACE "@" ";" text "${text}")
  file(CONFIGURE OUTPUT ${file} CONTENT
"PALPATE_${node}_${palpate_soversion} {
  global:
    extern \"C++\" {
    ${text}
    };
    descriptor_table_palpate_*;
  local:
    *;
};
")
endfunction()

# palpate_library(SET <core|client> OBJECTS <target>... LINKS <target>... NAMESPACES ... DOORS <header>... [ALSO ...])
# Targets palpate_<set>_static and palpate_<set>_shared, installed as palpate::<set>; palpate_<set>_headers: what is to
# be installed of ours.
function(palpate_library)
  cmake_parse_arguments(ARG "" "SET" "OBJECTS;LINKS;NAMESPACES;DOORS;ALSO" ${ARGN})
  palpate_headers_behind(headers ${ARG_DOORS})
  set(palpate_${ARG_SET}_headers ${headers} PARENT_SCOPE)
  set(script ${PROJECT_BINARY_DIR}/lib/palpate_${ARG_SET}.map)
  palpate_version_script(${script} ${ARG_SET} NAMESPACES ${ARG_NAMESPACES} HEADERS ${headers} ALSO ${ARG_ALSO})
  set(objects ${ARG_OBJECTS})
  list(TRANSFORM objects REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
  foreach(kind static shared)
    string(TOUPPER ${kind} KIND)
    set(target palpate_${ARG_SET}_${kind})
    add_library(${target} ${KIND} ${objects})
    set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX EXPORT_NAME ${ARG_SET}
      OUTPUT_NAME palpate_${ARG_SET} VERSION ${PROJECT_VERSION} SOVERSION ${palpate_soversion}
      ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_link_libraries(${target} PUBLIC ${ARG_LINKS})
    set(component dev)
    if(kind STREQUAL shared)
      set(component shared)
    endif()
    install(TARGETS ${target} EXPORT palpate-${ARG_SET}-${kind}-targets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
            INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${CMAKE_INSTALL_INCLUDEDIR}/palpate)
    install(EXPORT palpate-${ARG_SET}-${kind}-targets NAMESPACE palpate:: DESTINATION ${PALPATE_CMAKE_DIR}
            COMPONENT ${component})
  endforeach()
  # What a library inlines of others' templates stays its own; all symbols it needs are there, but for those of
  # sanitizers, which the program brings.
  target_link_options(palpate_${ARG_SET}_shared PRIVATE
    LINKER:--version-script=${script} LINKER:-z,now LINKER:-Bsymbolic-functions)
  if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    target_link_options(palpate_${ARG_SET}_shared PRIVATE LINKER:--no-undefined)
  endif()
  set_target_properties(palpate_${ARG_SET}_shared PROPERTIES LINK_DEPENDS ${script})
endfunction()
