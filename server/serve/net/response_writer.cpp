// server/serve/net/response_writer.cpp: one write in flight, never more.
#include "server/serve/net/response_writer.hpp"

#include <charconv>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>

namespace server::net {

using boost::system::error_code;

void ResponseWriter::write(std::shared_ptr<Host> host, Response response, const Manner& manner) {
  body_ = std::move(response.body);
  stream_ = std::move(response.stream);
  framing_ = !stream_ ? Framing::Length : manner.http_1_0 ? Framing::Close : Framing::Chunked;
  keep_alive_ = manner.keep_alive && framing_ != Framing::Close;
  const std::size_t size = body_ ? body_->size() : 0;
  head_ = response_head(response, size, keep_alive_, framing_);
  const bool bare = manner.head_only || response.status == 204 || response.status == 304;
  if (bare) stream_ = nullptr;
  send(std::move(host), bare || !body_ ? asio::const_buffer() : asio::buffer(*body_), size);
}

void ResponseWriter::send(std::shared_ptr<Host> host, asio::const_buffer body, std::size_t bytes) {
  host->writing(bytes);
  const std::array<asio::const_buffer, 2> buffers{asio::buffer(head_), body};
  asio::async_write(
      socket_, buffers, [this, host = std::move(host)](const error_code& error, std::size_t) {
        if (socket_.is_open()) on_written(host, error);
      });
}

void ResponseWriter::on_written(const std::shared_ptr<Host>& host, const error_code& error) {
  body_ = nullptr;
  if (error) {
    host->finish();
  } else if (stream_) {
    next_slice(host);
  } else if (keep_alive_) {
    host->written();
  } else {
    // Closing with unread input would reset the connection and might lose the answer. Stop sending,
    // then read and discard further input.
    error_code ignored;
    socket_.shutdown(Socket::shutdown_send, ignored);
    host->draining();
    drain(host);
  }
}

void ResponseWriter::next_slice(const std::shared_ptr<Host>& host) {
  host->waiting();
  stream_->next([this, weak = std::weak_ptr(host)](BodyStream::Slice slice) {
    const auto still = weak.lock();
    if (still && socket_.is_open()) write_slice(still, std::move(slice));
  });
}

void ResponseWriter::write_slice(const std::shared_ptr<Host>& host, BodyStream::Slice slice) {
  if (!slice) {
    // Reset the connection: an ordinary close would complete a body without a length.
    error_code ignored;
    socket_.set_option(asio::socket_base::linger(true, 0), ignored);
    host->finish();
    return;
  }
  slice_ = std::move(*slice);
  if (slice_.empty()) stream_ = nullptr;
  head_.clear();
  if (framing_ == Framing::Chunked) {
    std::array<char, 16> size{};
    const auto end = std::to_chars(size.data(), size.data() + size.size(), slice_.size(), 16).ptr;
    head_.append(size.data(), end).append("\r\n");
    slice_.append("\r\n");
  }
  send(host, asio::buffer(slice_), slice_.size());
}

void ResponseWriter::drain(std::shared_ptr<Host> host) {
  socket_.async_read_some(
      asio::buffer(drained_),
      [this, host = std::move(host)](const error_code& error, std::size_t) mutable {
        if (!socket_.is_open()) return;
        if (error) {
          host->finish();
        } else {
          drain(std::move(host));
        }
      });
}

}  // namespace server::net
