// server/serve/api/event_stream.cpp: looks, compares, sends.
#include "server/serve/api/event_stream.hpp"

#include <chrono>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "server/serve/api/api.hpp"

namespace server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLookEvery{250};
/// A comment after this silence: proxies close silent connections, and the stream must notice that
/// its client has gone.
constexpr std::chrono::seconds kSilence{10};

class EventStream final : public net::BodyStream, public std::enable_shared_from_this<EventStream> {
 public:
  using Look = std::function<std::optional<Event>(Worker&)>;
  EventStream(ApiContext& context, Look look) : context_(context), look_(std::move(look)) {}

  void next(std::function<void(Slice)> give) override {
    const std::chrono::milliseconds delay = sent_ ? kLookEvery : std::chrono::milliseconds(0);
    context_.server->after(delay, [self = shared_from_this(), give = std::move(give)] {
      self->context_.workers.post([self, give](Worker& worker) {
        std::optional<Event> event = self->look_(worker);
        self->context_.post_to_io(
            [self, give, event = std::move(event)] { self->send(event, give); });
      });
    });
  }

 private:
  void send(const std::optional<Event>& event, const std::function<void(Slice)>& give) {
    const Clock::time_point now = Clock::now();
    if (!event) {
      give(Slice(""));
    } else if (event != sent_) {
      sent_ = event;
      sent_at_ = now;
      give(fmt::format("event: {}\ndata: {}\n\n", event->name, event->data));
    } else if (now - sent_at_ >= kSilence) {
      sent_at_ = now;
      give(Slice(":\n\n"));
    } else {
      next(give);
    }
  }

  ApiContext& context_;
  Look look_;
  std::optional<Event> sent_{};  // io thread only
  Clock::time_point sent_at_{};
};

}  // namespace

net::Response event_stream(ApiContext& context, std::function<std::optional<Event>(Worker&)> look) {
  net::Response response;
  response.content_type = "text/event-stream";
  response.headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
  response.stream = std::make_shared<EventStream>(context, std::move(look));
  return response;
}

}  // namespace server
