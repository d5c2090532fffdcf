"""Programs of people who have palpate installed, and how they are built."""
import os
import subprocess

CIRCLE = """
#include <palpate/recognizer.h>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  std::vector<palpate::ContactSample> samples;
  for (int i = 0; i < 60; ++i) {
    samples.push_back({{0.1 + 0.02 * std::cos(0.1 * i), 0.02 * std::sin(0.1 * i)}, 1e-6, 0});
  }
  palpate::Recognizer recognizer;
  recognizer.add({}, samples);
  const palpate::Recognition answer = recognizer.recognize();
  std::printf("%s %.6f\\n", name_of(answer.shape.curve_class).data(), answer.shape.values[0]);
}
"""
PROBE = """
#include <palpate/client.h>

#include <cstdio>

int main() {
  palpate::v1::ContactBatch batch;
  batch.add_samples()->set_x_m(0.25);
  palpate::client::ContactPublisherOptions options;
  options.endpoint = "ipc://nobody-listens-here";
  palpate::client::ContactPublisher publisher(options);
  std::printf("%d %g %s\\n", publisher.wait_for_recognizer(std::chrono::milliseconds(10)), batch.samples(0).x_m(),
              palpate::make_topic(palpate::TopicKind::Contact, "finger").c_str());
}
"""
PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(stranger LANGUAGES CXX)
find_package(palpate 0.1 REQUIRED COMPONENTS core client)
add_executable(circle circle.cpp)
target_link_libraries(circle PRIVATE palpate::core)
add_executable(probe probe.cpp)
target_link_libraries(probe PRIVATE palpate::client)
"""
ANSWERS = {"circle": "circle 0.020000\n", "probe": "0 0.25 contact/finger/\n"}


def write_project(folder, project=PROJECT):
    folder.mkdir(parents=True)
    for name, text in (("circle.cpp", CIRCLE), ("probe.cpp", PROBE), ("CMakeLists.txt", project)):
        (folder / name).write_text(text)
    return folder


def call(*command, **environment):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, env=os.environ | environment)
    if done.returncode != 0:
        raise AssertionError(" ".join(map(str, command)) + "\n" + done.stdout + done.stderr)
    return done.stdout
