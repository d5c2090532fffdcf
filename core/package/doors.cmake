# The headers that others include: <palpate/recognizer.h>, <palpate/curve.h>, <palpate/part.h>, <palpate/given_class.h> and
# <palpate/client.h>, each a few lines that include ours. Only what lies behind these doors is installed.
set(palpate_doors_dir ${PROJECT_BINARY_DIR}/include)

set(palpate_recognizer_door core/recognition/recognizer.h)
set(palpate_curve_door core/curves/curve.h)
set(palpate_part_door core/part/closed_spline.h core/part/segment_match.h)
set(palpate_given_class_door core/recognition/given/given_class.h)
set(palpate_client_door node/client/connection.h node/client/contact_publisher.h node/client/result_subscriber.h
    node/wire/topics.h)
set(palpate_core_doors recognizer curve part given_class)

foreach(door IN LISTS palpate_core_doors ITEMS client)
  set(text "#pragma once\n\n")
  foreach(header IN LISTS palpate_${door}_door)
    string(APPEND text "#include \"${header}\"\n")
  endforeach()
  file(CONFIGURE OUTPUT ${palpate_doors_dir}/palpate/${door}.h CONTENT "${text}")
endforeach()
