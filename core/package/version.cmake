# The version where no tag tells it.
set(palpate_version_without_tag 0.1.0)

# palpate_version_by_tag(<out> <source folder>): of the nearest tag vMAJOR.MINOR.PATCH before what is
# checked out there, and as a fourth number how many commits came since; of none where it is the tag itself. Where the
# folder is no checkout of its own, or has no such tag, the version above.
function(palpate_version_by_tag out source)
  set(${out} ${palpate_version_without_tag} PARENT_SCOPE)
  find_program(PALPATE_GIT git)
  mark_as_advanced(PALPATE_GIT)
  # A checkout of somebody else's, which has this folder in it, has somebody else's tags.
  if(NOT PALPATE_GIT OR NOT EXISTS ${source}/.git)
    return()
  endif()
  execute_process(COMMAND ${PALPATE_GIT} -C ${source} describe --tags --long --match "v[0-9]*.[0-9]*.[0-9]*"
                  OUTPUT_VARIABLE described RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(failed OR NOT described MATCHES "^v([0-9]+\\.[0-9]+\\.[0-9]+)-([0-9]+)-g[0-9a-f]+$")
    return()
  endif()
  set(version ${CMAKE_MATCH_1})
  if(CMAKE_MATCH_2 GREATER 0)
    string(APPEND version .${CMAKE_MATCH_2})
  endif()
  set(${out} ${version} PARENT_SCOPE)
endfunction()

# cmake -P version.cmake: says it on standard error.
if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  cmake_path(SET palpate_source NORMALIZE ${CMAKE_CURRENT_LIST_DIR}/../..)
  palpate_version_by_tag(palpate_version ${palpate_source})
  message(NOTICE ${palpate_version})
endif()
