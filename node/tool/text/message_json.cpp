#include "node/tool/text/message_json.h"

#include <google/protobuf/util/json_util.h>

namespace palpate {

std::string json_line(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  // Cannot fail, because no message has an Any.
  (void)google::protobuf::util::MessageToJsonString(message, &text, options);
  return text + "\n";
}

}  // namespace palpate
