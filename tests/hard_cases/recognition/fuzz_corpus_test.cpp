// Runs each input of the fuzzing corpus once. A failure aborts and names the invariant that is
// broken.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace palpate {
namespace {

TEST(FuzzCorpus, OfTheRecognizerBreaksNoInvariant) {
  const auto folder =
      std::filesystem::path(PALPATE_TEST_DATA).parent_path() / "fuzz/corpus/recognizer";
  int inputs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    // If it aborts, the last name printed is the input.
    std::cout << entry.path().filename().string() << std::endl;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++inputs;
  }
  EXPECT_GT(inputs, 0);
}

}  // namespace
}  // namespace palpate
