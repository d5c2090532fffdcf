// The last N values of a stream as one contiguous span.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

namespace palpate {

/// Capacity is fixed at construction; push costs O(1) and never allocates. Every value is stored
/// twice, `capacity` apart, so that the newest ones are always contiguous.
template <typename T>
class RingBuffer {
 public:
  explicit RingBuffer(std::size_t capacity) : storage_(2 * capacity) { assert(capacity > 0); }

  void push(const T& value) {
    storage_[next_] = value;
    storage_[next_ + capacity()] = value;
    next_ = next_ + 1 == capacity() ? 0 : next_ + 1;
    size_ += size_ < capacity() ? 1 : 0;
  }

  /// The values in memory, oldest first; valid until the next push.
  std::span<const T> values() const { return {storage_.data() + start(), size_}; }
  /// The newest `count` (at most size()) of them, oldest first.
  std::span<const T> newest(std::size_t count) const {
    assert(count <= size_);
    return values().last(count);
  }

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return storage_.size() / 2; }
  bool full() const { return size_ == capacity(); }
  void clear() {
    next_ = 0;
    size_ = 0;
  }

 private:
  std::size_t start() const { return full() ? next_ : 0; }

  std::vector<T> storage_;
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace palpate
