// server/serve/api/worker_reply.cpp: passes work from the io thread to a worker, and the answer
// back.
#include "server/serve/api/worker_reply.hpp"

#include <algorithm>
#include <exception>

#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"

namespace server {

namespace {

/// A responder for any thread that answers through the io thread. If it is dropped unused, it
/// answers 500 there too.
net::Responder through_io(ApiContext& context, const net::Responder& respond) {
  return net::Responder([&context, respond](net::Response response) {
    context.post_to_io([respond, response = std::move(response)] { respond(response); });
  });
}

Routes::Answer answer_of(Routes::Make make) {
  return [make = std::move(make)](ApiContext& context,
                                  const net::Request& request,
                                  Worker& worker,
                                  const net::Responder& respond) {
    respond(context.room.admit(make(context, request, worker)));
  };
}

}  // namespace

void Routes::work(const char* method, const std::string& path, Answer answer) {
  work(method, path, std::move(answer), context_.workers);
}

void Routes::work(const char* method, const std::string& path, Answer answer, Workers& workers) {
  router_.add(method,
              "/api/v1" + path,
              [&context = context_, &workers, answer = std::move(answer)](
                  const net::Request& request, const net::Responder& respond) {
                workers.post([&context, answer, request, through = through_io(context, respond)](
                                 Worker& worker) {
                  try {
                    answer(context, request, worker, through);
                  } catch (...) {
                    through(problem_of_current_exception());
                  }
                });
              });
}

void Routes::make(const char* method, const std::string& path, Make make) {
  work(method, path, answer_of(std::move(make)));
}

void Routes::make_in_turn(const char* method, const std::string& path, Make make) {
  work(method, path, answer_of(std::move(make)), context_.checker);
}

void Routes::answer(
    const char* method,
    const std::string& path,
    std::function<void(ApiContext&, const net::Request&, const net::Responder&)> answer,
    std::size_t body_bytes) {
  router_.add(method,
              "/api/v1" + path,
              guarded([&context = context_, answer = std::move(answer)](
                          const net::Request& request, const net::Responder& respond) {
                answer(context, request, respond);
              }),
              body_bytes);
}

void Routes::at_once(const char* method, const std::string& path, MakeAtOnce make) {
  answer(method,
         path,
         [make = std::move(make)](
             ApiContext& context, const net::Request& request, const net::Responder& respond) {
           respond(make(context, request));
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
