// server/serve/net/response_writer.hpp: writes an answer to a socket, whole or slice by slice, and
// ends the connection after the last one. Internal to server/net.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "server/serve/net/core.hpp"

namespace server::net {

/// Writes one answer after another. Makes a slice when the client has taken the last one.
class ResponseWriter {
 public:
  /// The connection it writes for. Gets no calls after the socket is closed.
  class Host {
   public:
    virtual void writing(std::size_t bytes) = 0;  // this many bytes are being sent
    virtual void waiting() = 0;                   // waits for the next slice
    virtual void written() = 0;                   // the next request may come
    virtual void draining() = 0;                  // the last answer has been sent
    virtual void finish() = 0;                    // close the connection

   protected:
    ~Host() = default;
  };

  struct Manner {
    bool keep_alive = false;
    bool http_1_0 = false;
    bool head_only = false;
  };

  explicit ResponseWriter(Socket& socket) : socket_(socket) {}

  /// `host` is kept alive while a write is in progress.
  void write(std::shared_ptr<Host> host, Response response, const Manner& manner);

 private:
  void send(std::shared_ptr<Host> host, asio::const_buffer body, std::size_t bytes);
  void on_written(const std::shared_ptr<Host>& host, const boost::system::error_code& error);
  void next_slice(const std::shared_ptr<Host>& host);
  void write_slice(const std::shared_ptr<Host>& host, BodyStream::Slice slice);
  void drain(std::shared_ptr<Host> host);

  Socket& socket_;
  std::string head_{};
  Payload body_{};
  std::shared_ptr<BodyStream> stream_{};
  Framing framing_ = Framing::Length;
  std::string slice_{};
  bool keep_alive_ = false;
  std::array<char, 4096> drained_{};
};

}  // namespace server::net
