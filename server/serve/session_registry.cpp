// server/serve/session_registry.cpp: opens and finds sessions, and ends them in several steps.
#include "server/serve/session_registry.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "server/record/run_json.hpp"
#include "server/serve/net/http.hpp"
#include "server/serve/net/secret.hpp"

namespace server {
namespace {

/// Only `main` reports the recorder's news, which concern the whole server.
SessionHouse of_visitors(SessionHouse house) {
  house.runs.tells_record_news = false;
  return house;
}

/// An ending session. Its run is destroyed before it.
struct Parting {
  std::shared_ptr<OpenSession> session{};
  std::unique_ptr<LiveRun> last{};
};

}  // namespace

SessionRegistry::SessionRegistry(SessionHouse house, const SessionRules& rules)
    : house_(std::move(house)),
      rules_(rules),
      main_(std::make_shared<OpenSession>(std::string(kMain), house_, 0)),
      all_{main_.get()} {}

SessionRegistry::~SessionRegistry() = default;

OpenSession* SessionRegistry::find(std::string_view id) {
  if (id == kMain) return main_.get();
  const auto found = sessions_.find(id);
  if (found == sessions_.end()) return nullptr;
  found->second->used(Clock::now());
  return found->second.get();
}

void SessionRegistry::open(SessionLoader::Make make, Opened done) {
  if (sessions_.size() + opening_.size() >= rules_.sessions) {
    throw net::HttpError(503,
                         fmt::format("There are {} sessions, as many as this server has room for. "
                                     "Try again later.",
                                     rules_.sessions));
  }
  const auto made = std::make_shared<OpenSession>(net::secret(), of_visitors(house_), rules_.runs);
  opening_.push_back(made);
  made->loader().load([make = std::move(make)] { return make; },
                      [this, session = made.get(), done = std::move(done)](
                          const std::exception_ptr& failure) { loaded(session, failure, done); });
}

void SessionRegistry::loaded(const OpenSession* session,
                             const std::exception_ptr& failure,
                             const Opened& done) {
  const auto it = std::ranges::find(opening_, session, [](const auto& s) { return s.get(); });
  const std::shared_ptr<OpenSession> made = std::move(*it);
  opening_.erase(it);
  if (failure) {
    ending_.push_back(made);  // its loader still uses it
    done(nullptr, failure);
    return;
  }
  made->used(Clock::now());
  sessions_.emplace(made->id(), made);
  all_.push_back(made.get());
  done(made.get(), nullptr);
}

bool SessionRegistry::end(std::string_view id) {
  const auto found = sessions_.find(id);
  if (found == sessions_.end()) return false;
  const std::shared_ptr<OpenSession> session = std::move(found->second);
  sessions_.erase(found);
  std::erase(all_, session.get());
  see_off(*session);
  ending_.push_back(session);
  bury();
  return true;
}

/// Tells the session's viewers and detaches them.
void SessionRegistry::see_off(const OpenSession& session) {
  for (auto it = clients_.begin(); it != clients_.end();) {
    if (it->second.session != &session) {
      ++it;
      continue;
    }
    const std::shared_ptr<net::WsClient> socket = it->second.socket;
    it = clients_.erase(it);
    session.door().on_close(*socket);
    socket->close(kGoneCode, "This session has ended.");
  }
}

/// A load in progress must end first. Then a worker waits for the run's last tick, and the io
/// thread destroys the session.
void SessionRegistry::bury() {
  for (const auto& session : ending_) {
    if (session->loader().waiting() > 0) continue;
    auto parting = std::make_shared<Parting>(Parting{session, session->session().part()});
    house_.workers.post([parting, to_io = house_.to_io](Worker&) mutable {
      parting->last.reset();
      to_io([parting = std::move(parting)] {});
    });
  }
  std::erase_if(ending_, [](const auto& session) { return session->loader().waiting() == 0; });
}

bool SessionRegistry::take_news(Clock::time_point now) {
  bool left = false;
  in_turn_ = all_;  // a session may open or end another meanwhile
  for (OpenSession* session : in_turn_) {
    if (!session->has_news()) continue;
    if (now - session->last_tended() < kLeast) {
      left = true;
    } else {
      session->tend(now);
    }
  }
  return left;
}

void SessionRegistry::tend(Clock::time_point now) {
  std::vector<std::string> idle;
  in_turn_ = all_;
  for (OpenSession* session : in_turn_) {
    session->tend(now);
    if (session->bridge().hub().clients() > 0) session->used(now);
    if (session != main_.get() && now - session->last_used() > rules_.idle) {
      idle.push_back(session->id());
    }
  }
  for (const std::string& id : idle) end(id);
  bury();
}

net::WsEndpoint SessionRegistry::endpoint() {
  net::WsEndpoint out;
  out.path = main_->door().path;
  out.subprotocols = main_->door().subprotocols;
  out.on_open = [this](const std::shared_ptr<net::WsClient>& socket) { opened(socket); };
  out.on_close = [this](net::WsClient& socket) { closed(socket); };
  const auto hand_on = [this](auto on_message) {
    return [this, on_message](net::WsClient& socket, std::string_view message) {
      const auto found = clients_.find(socket.id());
      if (found == clients_.end()) return;
      (found->second.session->door().*on_message)(socket, message);
    };
  };
  out.on_text = hand_on(&net::WsEndpoint::on_text);
  out.on_binary = hand_on(&net::WsEndpoint::on_binary);
  return out;
}

void SessionRegistry::opened(const std::shared_ptr<net::WsClient>& socket) {
  const auto asked = socket->query().find("session");
  const bool named = asked != socket->query().end();
  if (!named && rules_.per_visitor) {
    socket->close(kGoneCode, kOwn);
    return;
  }
  OpenSession* const session = find(named ? std::string_view(asked->second) : kMain);
  if (session == nullptr) {
    socket->close(kGoneCode, kGone);
    return;
  }
  clients_[socket->id()] = {socket, session, wall_time()};
  session->door().on_open(socket);
}

std::vector<SessionClient> SessionRegistry::clients() const {
  std::vector<SessionClient> out;
  out.reserve(clients_.size());
  for (const auto& [id, client] : clients_) {
    out.push_back({client.socket, client.session->id(), client.since});
  }
  return out;
}

void SessionRegistry::closed(net::WsClient& socket) {
  const auto found = clients_.find(socket.id());
  if (found == clients_.end()) return;
  OpenSession& session = *found->second.session;
  clients_.erase(found);
  session.used(Clock::now());
  session.door().on_close(socket);
}

void SessionRegistry::end_all() {
  for (OpenSession* session : all()) session->session().end(true);
  for (const auto& session : opening_) session->session().end(true);
  for (const auto& session : ending_) session->session().end(true);
}

}  // namespace server
