// server/external/shared_object.hpp: controllers in a shared object (tautline_controller.h).
#pragma once

#include <memory>
#include <string>

#include "server/external/peer.hpp"
#include "server/external/texts.hpp"

namespace server::external {

/// Keeps the object loaded while any of its controllers lives.
class SharedObjectSource final : public PeerSource {
 public:
  /// `name`: of the controller, for sentences. Throws ControllerError if the file cannot be loaded,
  /// lacks a function, or is of another version.
  SharedObjectSource(std::string name, const std::string& path);
  ~SharedObjectSource() override;
  SharedObjectSource(const SharedObjectSource&) = delete;
  SharedObjectSource& operator=(const SharedObjectSource&) = delete;

  std::unique_ptr<Peer> take(const std::stop_token& stop) override;
  void give_back(std::unique_ptr<Peer> peer, bool well) override;

  struct Functions;

 private:
  std::string name_;
  Texts texts_{};
  std::unique_ptr<Functions> functions_;
};

}  // namespace server::external
