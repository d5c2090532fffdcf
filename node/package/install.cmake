# Installs what comes with the programs: manual pages, completions, the services and their configurations.

# Manual pages, completions and node.textproto are generated from the programs' own --help and --print-config.
set(programs palpate palpate-node)
if(TARGET palpate-sim)
  list(APPEND programs palpate-sim)
endif()
if(TARGET palpate-gateway)
  list(APPEND programs palpate-gateway)
  install(TARGETS palpate-gateway RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT gateway)
endif()
set(folder ${PROJECT_BINARY_DIR}/manual)
set(files ${folder}/node.textproto)
set(paths)
foreach(program IN LISTS programs)
  list(APPEND files ${folder}/man/${program}.1 ${folder}/bash/${program} ${folder}/zsh/_${program})
  list(APPEND paths $<TARGET_FILE:${program}>)
endforeach()
foreach(program IN LISTS programs)
  target_link_options(${program} PRIVATE LINKER:-z,relro,-z,now)
endforeach()
find_program(PALPATE_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT PALPATE_PYTHON)
  message(STATUS "palpate: no python3, so no manual pages and no completions")
  return()
endif()
add_custom_command(OUTPUT ${files}
  COMMAND ${PALPATE_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/manual.py ${folder} ${paths}
  COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:palpate-node> -DOUT=${folder}/node.textproto
          -P ${CMAKE_CURRENT_LIST_DIR}/configuration.cmake
  DEPENDS ${programs} ${CMAKE_CURRENT_LIST_DIR}/manual.py ${CMAKE_CURRENT_LIST_DIR}/configuration.cmake
  COMMENT "Manual pages and completions" VERBATIM)
add_custom_target(palpate_manual ALL DEPENDS ${files})

# The gateway has a package of its own, so that nobody else needs NATS.
foreach(component runtime gateway)
  set(whose REGEX "palpate-gateway" EXCLUDE)
  if(component STREQUAL gateway)
    set(whose FILES_MATCHING REGEX "palpate-gateway")
  endif()
  install(DIRECTORY ${folder}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component} ${whose})
  install(DIRECTORY ${folder}/bash/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ${component} ${whose})
  install(DIRECTORY ${folder}/zsh/ DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT ${component} ${whose})
endforeach()
if(TARGET palpate-gateway)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/palpate-gateway@.service DESTINATION lib/systemd/system COMPONENT gateway)
  install(DIRECTORY ${CMAKE_CURRENT_LIST_DIR}/plant DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate COMPONENT gateway)
endif()
install(FILES ${folder}/node.textproto DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate COMPONENT runtime)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/palpate-node.service DESTINATION lib/systemd/system COMPONENT runtime)
