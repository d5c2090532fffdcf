# Writes the node's options with their defaults, each as a comment:
#   cmake -DPROGRAM=palpate-node -DOUT=FILE -P configuration.cmake
execute_process(COMMAND ${PROGRAM} --print-config OUTPUT_VARIABLE options
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "\n$" "" options "${options}")
string(REPLACE "\n" "\n# " options "# ${options}")
file(WRITE ${OUT} "# Options of palpate-node.service, protobuf text format; palpate-node(1) says what each means.
# These are the defaults. Check a change by: palpate-node --config /etc/palpate/node.textproto --check-config
${options}
")
