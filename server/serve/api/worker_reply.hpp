// server/serve/api/worker_reply.hpp: answers made on a worker, bounded in bytes.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "server/serve/net/http.hpp"
#include "server/serve/net/router.hpp"
#include "server/serve/workers.hpp"

namespace server {

struct ApiContext;

/// Adds routes below /api/v1.
class Routes {
 public:
  using Answer =
      std::function<void(ApiContext&, const net::Request&, Worker&, const net::Responder&)>;
  using Make = std::function<net::Response(ApiContext&, const net::Request&, Worker&)>;
  using MakeAtOnce = std::function<net::Response(ApiContext&, const net::Request&)>;

  Routes(net::Router& router, ApiContext& context) : router_(router), context_(context) {}

  /// `answer` runs on a worker, where it may read, wait and build. It answers now or later, from
  /// any thread. Its exceptions become problem documents.
  void work(const char* method, const std::string& path, Answer answer);
  void work(const char* method, const std::string& path, Answer answer, Workers& workers);
  /// As work(), for a function that returns its answer.
  void make(const char* method, const std::string& path, Make make);
  /// On a thread of its own, in turn: for a check that may take a minute.
  void make_in_turn(const char* method, const std::string& path, Make make);
  /// These run on the io thread. The first answers now or later, the second at once.
  void answer(const char* method,
              const std::string& path,
              std::function<void(ApiContext&, const net::Request&, const net::Responder&)> answer,
              std::size_t body_bytes = net::Router::kAnyBody);
  void at_once(const char* method, const std::string& path, MakeAtOnce make);

 private:
  net::Router& router_;
  ApiContext& context_;
};

/// Runs `make` on a worker and sends its result through `respond`.
void answer_from_worker(ApiContext& context,
                        const net::Responder& respond,
                        std::function<net::Response(Worker&)> make);

/// Limits the memory of answers made on workers, for all clients together, until they are sent. A
/// page of runs, ticks or frames ends with the item that fills it, and says where the next page
/// begins. While many clients read slowly, pages get shorter. Any thread.
class PageRoom {
 public:
  /// [bytes] after which a page made now ends.
  std::size_t page() const;
  /// The page as a body. It counts until it has been sent.
  net::Payload hold(std::string page);
  /// The answer with its body counted; 503 if it is large and there is no room for it.
  net::Response admit(net::Response answer);

 private:
  static constexpr std::size_t kPage = std::size_t{4} << 20;
  static constexpr std::size_t kLeast = std::size_t{64} << 10;
  static constexpr std::size_t kAll = std::size_t{64} << 20;

  std::shared_ptr<std::atomic<std::size_t>> held_ = std::make_shared<std::atomic<std::size_t>>(0);
};

/// A body whose slices are made on workers, each after the client has taken the one before.
class WorkerStream final : public net::BodyStream,
                           public std::enable_shared_from_this<WorkerStream> {
 public:
  /// Makes the next slice; an empty one follows the last. Throws if the rest cannot be made. Calls
  /// never overlap, but may come from different workers.
  using Make = std::function<std::string(Worker&)>;

  WorkerStream(ApiContext& context, Make make) : context_(context), make_(std::move(make)) {}
  void next(std::function<void(Slice)> give) override;

 private:
  ApiContext& context_;
  Make make_;
};

}  // namespace server
