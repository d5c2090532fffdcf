// Example of a probe: publishes touched points. Replace the body of the loop by your own driver.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <thread>

#include "node/client/connection.h"
#include "node/client/contact_publisher.h"

int main(int argc, char** argv) try {
  if (argc > 1 && std::string_view(argv[1]) == "--help") {
    std::printf("usage: %s [ENDPOINT [SECRET_KEY_FILE RECOGNIZER_PUBLIC_KEY_FILE]]\n", argv[0]);
    return 0;
  }
  palpate::client::ContactPublisherOptions options;
  if (argc > 1) options.endpoint = argv[1];
  if (argc > 2) {  // CURVE: our secret key file, the recognizer's public key file
    const auto keys = palpate::client::read_curve_client(argv[2], argc > 3 ? argv[3] : "");
    if (!keys) {
      std::fprintf(stderr, "%s\n", keys.error.c_str());
      return 2;
    }
    options.curve = *keys.value;
  }
  palpate::client::ContactPublisher publisher(options);
  std::fprintf(stderr, "waiting for a recognizer at %s (palpate-node)\n", options.endpoint.c_str());
  if (!publisher.wait_for_recognizer(std::chrono::seconds(5))) {
    std::fprintf(stderr, "no recognizer on %s\n", options.endpoint.c_str());
    return 1;
  }

  palpate::v1::ContactBatch batch;
  batch.set_object(1);  // a new number = a new object
  batch.set_patch(0);   // add 1 at each lift-off
  for (int i = 0; i < 240; ++i) {
    // An ellipse with half axes of 40 mm and 25 mm, one point about every 0.5 mm.
    const double t = 0.4 + 0.012 * i;
    palpate::v1::ContactSample& sample = *batch.add_samples();
    sample.set_x_m(0.3 + 0.040 * std::cos(t));
    sample.set_y_m(0.1 + 0.025 * std::sin(t));
    if (batch.samples_size() == 10) {
      publisher.publish("finger", batch);
      batch.clear_samples();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
} catch (const std::exception& error) {  // e.g. an endpoint that is none
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
