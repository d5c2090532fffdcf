// Example of a planner: prints each recognised curve and where it lies.
#include <chrono>
#include <cstdio>
#include <exception>
#include <string_view>

#include "node/client/connection.h"
#include "node/client/result_subscriber.h"

int main(int argc, char** argv) try {
  if (argc > 1 && std::string_view(argv[1]) == "--help") {
    std::printf("usage: %s [ENDPOINT [SECRET_KEY_FILE RECOGNIZER_PUBLIC_KEY_FILE]]\n", argv[0]);
    return 0;
  }
  palpate::client::ResultSubscriberOptions options;
  if (argc > 1) options.endpoint = argv[1];
  if (argc > 2) {  // CURVE: our secret key file, the recognizer's public key file
    const auto keys = palpate::client::read_curve_client(argv[2], argc > 3 ? argv[3] : "");
    if (!keys) {
      std::fprintf(stderr, "%s\n", keys.error.c_str());
      return 2;
    }
    options.curve = *keys.value;
  }
  palpate::client::ResultSubscriber subscriber(options);
  std::fprintf(stderr, "listening to %s (palpate-node)\n", options.endpoint.c_str());
  for (;;) {
    // A planner needs only the newest state: update() reads everything that has come.
    if (!subscriber.update(std::chrono::seconds(1))) continue;
    for (const std::string& group : subscriber.groups()) {
      const palpate::v1::Recognition& answer = *subscriber.latest(group);
      if (answer.status() != palpate::v1::RECOGNITION_STATUS_RECOGNIZED) continue;
      std::printf("%s: %s at x = %.5f m, y = %.5f m, theta = %.4f rad\n", group.c_str(),
                  palpate::v1::CurveClass_Name(answer.curve_class()).c_str(), answer.pose().x_m(),
                  answer.pose().y_m(), answer.pose().theta_rad());
      std::fflush(stdout);
    }
  }
} catch (const std::exception& error) {  // e.g. an endpoint that is none
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
