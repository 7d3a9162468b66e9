// algo/recycled.hpp: a vector whose elements keep their buffers across clear(). A control tick that
// fills the same lists again and again then allocates nothing.
#pragma once

#include <cstddef>
#include <vector>

namespace algo {

template <typename T>
class Recycled {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }
  /// Creates `count` elements for append() to hand out.
  void reserve(std::size_t count) {
    if (items_.size() < count) items_.resize(count);
  }

  /// Appends an element. It still holds its value from before the last clear(): overwrite every
  /// field.
  T& append() {
    if (size_ == items_.size()) items_.emplace_back();
    return items_[size_++];
  }
  void push_back(const T& value) { append() = value; }
  void pop_back() { --size_; }

  T& operator[](std::size_t i) { return items_[i]; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }
  T& back() { return items_[size_ - 1]; }
  const T& back() const { return items_[size_ - 1]; }

  Recycled() = default;
  ~Recycled() = default;
  Recycled(Recycled&& other) noexcept = default;
  Recycled& operator=(Recycled&& other) noexcept = default;
  Recycled(const Recycled& other) : items_(other.begin(), other.end()), size_(other.size_) {}
  /// Copies each element into the buffers already here.
  Recycled& operator=(const Recycled& other) {
    if (this == &other) return *this;
    clear();
    for (const T& item : other) push_back(item);
    return *this;
  }

 private:
  std::vector<T> items_{};
  std::size_t size_ = 0;
};

}  // namespace algo
