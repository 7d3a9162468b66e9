// server/serve/net/body_room.hpp: limits the memory of large request bodies, for all clients
// together.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

namespace server::net {

/// Counts the bytes of a large request body from its first byte to the answer. Small bodies, such
/// as a Stop, always pass. Io thread only; must outlive its places.
class BodyRoom {
 public:
  static constexpr std::size_t kSmall = std::size_t{16} << 10;  // [bytes]
  static constexpr std::size_t kAll = std::size_t{64} << 20;    // [bytes]

  /// The bytes of one body, returned by the destructor.
  class Place {
   public:
    Place() = default;
    Place(BodyRoom& room, std::size_t bytes) : room_(&room), bytes_(bytes) {
      room_->taken_ += bytes_;
    }
    Place(Place&& other) noexcept
        : room_(std::exchange(other.room_, nullptr)), bytes_(other.bytes_) {}
    Place& operator=(Place&& other) noexcept {
      std::swap(room_, other.room_);
      std::swap(bytes_, other.bytes_);
      return *this;
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place() {
      if (room_ != nullptr) room_->taken_ -= bytes_;
    }

   private:
    BodyRoom* room_ = nullptr;
    std::size_t bytes_ = 0;
  };

  /// Nothing if there is no room for `bytes` more.
  std::optional<Place> take(std::size_t bytes) {
    if (bytes <= kSmall) return Place();
    if (taken_ + bytes > kAll) return std::nullopt;
    return Place(*this, bytes);
  }

 private:
  std::size_t taken_ = 0;
};

}  // namespace server::net
