// Numbers and choices from a fuzzer's bytes; zeros once these are used up.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace palpate {

class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  std::uint8_t byte() {
    if (left_ == 0) {
      return 0;
    }
    --left_;
    return *data_++;
  }

  /// In [0, n).
  int below(int n) { return byte() % n; }

  /// In [-1, 1], two bytes.
  double unit() {
    const int high = byte();
    return (256 * high + byte() - 32768) / 32768.0;
  }

  /// A power of ten: mostly within 10^+-`usual`, one in sixteen within 10^+-`extreme`.
  double power_of_ten(double usual, double extreme) {
    const bool is_extreme = below(16) == 15;
    return std::pow(10.0, (is_extreme ? extreme : usual) * unit());
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

}  // namespace palpate
