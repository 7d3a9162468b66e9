// sim/bullet_ptr.hpp: ownership of Bullet objects.
#pragma once

#include <memory>
#include <utility>

namespace sim {

/// Bullet's classes have their own allocation operators. clang's analyzer believes that these
/// access freed memory. The global ones align equally (16 bytes) and raise no warning.
struct BulletDelete {
  template <typename T>
  void operator()(T* object) const {
    ::delete object;
  }
};

template <typename T>
using BulletPtr = std::unique_ptr<T, BulletDelete>;

template <typename T, typename... Arguments>
BulletPtr<T> make_bullet(Arguments&&... arguments) {
  return BulletPtr<T>(::new T(std::forward<Arguments>(arguments)...));
}

}  // namespace sim
