// server/serve/api/worker_reply.cpp: from the io thread to a worker and back.
#include "server/serve/api/worker_reply.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"

namespace server {

namespace {

/// Answers through the io thread, from any. Left unused on any thread, it answers 500 there too.
net::Responder through_io(ApiContext& context, const net::Responder& respond) {
  return net::Responder([&context, respond](net::Response response) {
    context.post_to_io([respond, response = std::move(response)] { respond(response); });
  });
}

}  // namespace

net::Handler on_worker(
    ApiContext& context,
    std::function<void(const net::Request&, Worker&, const net::Responder&)> handler) {
  return [&context, handler = std::move(handler)](const net::Request& request,
                                                  const net::Responder& respond) {
    context.workers.post([handler, request, answer = through_io(context, respond)](Worker& worker) {
      try {
        handler(request, worker, answer);
      } catch (...) {
        answer(problem_of_current_exception());
      }
    });
  };
}

net::Handler made_on_worker(ApiContext& context,
                            std::function<net::Response(const net::Request&, Worker&)> handler) {
  return on_worker(context,
                   [&context, handler = std::move(handler)](
                       const net::Request& request, Worker& worker, const net::Responder& respond) {
                     respond(context.room.admit(handler(request, worker)));
                   });
}

void answer_from_worker(ApiContext& context,
                        const net::Responder& respond,
                        std::function<net::Response(Worker&)> make) {
  context.workers.post(
      [&context, make = std::move(make), answer = through_io(context, respond)](Worker& worker) {
        try {
          answer(context.room.admit(make(worker)));
        } catch (...) {
          answer(problem_of_current_exception());
        }
      });
}

std::size_t PageRoom::page() const {
  const std::size_t held = std::min(kAll, held_->load());
  return std::clamp((kAll - held) / 8, kLeast, kPage);
}

net::Payload PageRoom::hold(std::string page) {
  page.shrink_to_fit();
  const std::size_t bytes = page.size();
  held_->fetch_add(bytes);
  return {new const std::string(std::move(page)), [held = held_, bytes](const std::string* body) {
            delete body;
            held->fetch_sub(bytes);
          }};
}

net::Response PageRoom::admit(net::Response answer) {
  if (!answer.body || answer.body->size() <= kLeast) return answer;
  if (held_->load() + answer.body->size() > kAll) {
    net::Response busy = net::problem(
        503, "Busy", "Many large answers wait for slow clients to take them. Try again later.");
    busy.headers.push_back({"Retry-After", "5"});
    return busy;
  }
  answer.body = hold(*answer.body);
  return answer;
}

void WorkerStream::next(std::function<void(Slice)> give) {
  context_.workers.post([self = shared_from_this(), give = std::move(give)](Worker& worker) {
    Slice slice;
    try {
      slice = self->make_(worker);
    } catch (const std::exception&) {
      slice.reset();  // the client sees a broken connection
    }
    self->context_.post_to_io(
        [give, slice = std::move(slice)]() mutable { give(std::move(slice)); });
  });
}

}  // namespace server
