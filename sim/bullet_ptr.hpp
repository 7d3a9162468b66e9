// sim/bullet_ptr.hpp: ownership of Bullet objects.
#pragma once

#include <memory>
#include <utility>

namespace sim {

/// Bullet's classes bring allocation operators of their own, of which clang's analyzer believes
/// that they touch what they have freed. The global ones align as well (16 bytes) and keep it
/// quiet.
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
