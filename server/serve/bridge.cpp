// server/serve/bridge.cpp: the outgoing channels and the incoming topics.
#include "server/serve/bridge.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "algo/pipeline/parameter_table.hpp"
#include "server/record/encoded_frame.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/paths.hpp"
#include "server/run/request_json.hpp"
#include "server/serve/layers_json.hpp"
#include "server/serve/operator_watch.hpp"
#include "server/serve/scene_json.hpp"
#include "server/serve/session_json.hpp"

namespace server {
namespace {

using foxglove::ChannelId;
using foxglove::ClientId;
using foxglove::ServiceReply;
using nlohmann::json;
constexpr std::chrono::milliseconds kPathPeriod{500};  // the whole path is sent each time
constexpr int kStateShare = 9;  // next state after this many times its publishing time

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::function<void(std::exception_ptr)> answer_when_loaded(const ServiceReply& reply) {
  return [reply](const std::exception_ptr& failure) {
    if (!failure) {
      reply.success({{"ok", true}});
      return;
    }
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& e) {
      reply.failure(without_folders(e.what()));
    }
  };
}

}  // namespace

std::vector<foxglove::Parameter> Bridge::Gains::list() const {
  std::vector<foxglove::Parameter> out;
  for (const algo::ParameterInfo* p : algo::parameter_table()) {
    out.push_back({std::string(p->key()), shown_[*p], "float64"});
  }
  const sim::Scenario& scenario = bridge_.session_.state().spec.scenario;
  out.push_back({"controller", scenario.controller, ""});
  out.push_back({"filter", scenario.filter, ""});
  out.push_back({"scenario", scenario.name, ""});
  out.push_back({kTwistMode, std::string(algo::name(bridge_.twist_mode_)), ""});
  return out;
}

std::string Bridge::Gains::set(ClientId client, const std::string& name, const json& value) {
  if (const auto refusal = admit_deed(bridge_.session_, bridge_.sender(client))) return *refusal;
  if (name == kTwistMode) return bridge_.set_twist_mode(value);
  const algo::ParameterInfo* const parameter = algo::find_parameter(name);
  if (parameter == nullptr) {
    const bool read_only = name == "controller" || name == "filter" || name == "scenario";
    return read_only ? "'" + name + "' is read only here: call the service /load."
                     : "There is no parameter '" + name + "'.";
  }
  if (!value.is_number()) return "'" + name + "' takes a number.";
  const double wanted = value.get<double>();
  if (const auto why = algo::refusal(shown_, *parameter, wanted)) return *why;
  ++on_their_way_;
  shown_.set(*parameter, wanted);
  const auto given = bridge_.session_.submit(
      algo::SetParameter{parameter, wanted}, [this](const std::optional<std::string>& refusal) {
        --on_their_way_;
        follow();
        if (refusal) {
          bridge_.hub_.announce(foxglove::StatusLevel::Warning, *refusal);
          bridge_.hub_.parameters_changed();
        }
      });
  if (given) return {};
  --on_their_way_;
  follow();
  return kBusy;
}

void Bridge::Gains::follow() {
  if (on_their_way_ == 0) shown_ = bridge_.session_.state().asked.parameters;
}

Bridge::Bridge(Session& session, Loads loads) : session_(session), loads_(std::move(loads)) {
  hub_.set_parameters(gains_);
  add_channels();
  add_services();
  add_topics();
  session_.on_frame = [this](const FrameRef& frame) { publish_frame(frame); };
  session_.on_change = [this] { state_changed(); };
  session_.on_log = [this](LogLevel level, const std::string& text) {
    const double stamp = static_cast<double>(now_ns()) * 1e-9;
    hub_.publish_event(log_, now_ns(), shared(log_json(stamp, level, without_folders(text))));
  };
}

std::uint64_t Bridge::now_ns() const {
  if (!session_.newest()) return 0;
  const double stamp = session_.newest()->telemetry.observation.stamp;
  return static_cast<std::uint64_t>(std::max(0.0, stamp) * 1e9);
}

void Bridge::add_channels() {
  // Encoded only while a client subscribes: each frame, and the newest one for a new subscriber.
  const auto drawn = [this](const char* topic,
                            const char* schema,
                            std::function<std::string(const algo::Telemetry&)> encode,
                            const FrameRef& newest) {
    return hub_.add_channel({topic, schema, [this, &newest, encode = std::move(encode)] {
                               return newest ? foxglove::Stamped{now_ns(),
                                                                 shared(encode(newest->telemetry))}
                                             : foxglove::Stamped{};
                             }});
  };
  const FrameRef& newest = session_.newest();
  telemetry_ = hub_.add_channel(
      {"/telemetry", "tautline.wire.Frame", [this, &newest] {
         return newest ? foxglove::Stamped{now_ns(), with_news(*newest)} : foxglove::Stamped{};
       }});
  state_ = hub_.add_channel({"/state", "tautline.State"});
  scan_ = drawn("/scan", "foxglove.LaserScan", laser_scan_json, session_.newest_scan());
  tf_ = drawn("/tf", "foxglove.FrameTransforms", transforms_json, newest);
  odom_ = drawn("/odom", "foxglove.Odometry", odometry_json, newest);
  layers_ = drawn("/layers", "foxglove.SceneUpdate", layers_json, newest);
  filtered_ = drawn(
      "/tautline/filtered",
      "tautline.wire.LaserScan",
      [this](const algo::Telemetry& t) { return text_of(encoder_.encode(t.scene.scan)); },
      session_.newest_scan());
  obstacles_ = hub_.add_channel({"/obstacles", "foxglove.SceneUpdate"});
  goal_ = drawn("/goal", "foxglove.PoseInFrame", goal_json, newest);
  trajectory_ = drawn(
      "/trajectory",
      "foxglove.PosesInFrame",
      [this](const algo::Telemetry& t) { return session_.path().message(t.observation.stamp); },
      newest);
  log_ = hub_.add_channel({"/log", "foxglove.Log"});
}

void Bridge::sign_of(ClientId client) {
  session_.watch().page_sign(client, OperatorWatch::Clock::now());
}

Sender Bridge::sender(ClientId client) const {
  const net::Visitor& who = hub_.who(client);
  return {{client, who.label(), who.role}, {}};
}

void Bridge::submit(ClientId client, StampedRequest request, const ServiceReply& reply) {
  const net::Visitor& who = hub_.who(client);
  if (who.role < needed_for(request.request)) {
    throw std::runtime_error(net::role_refusal(who.role, needed_for(request.request)));
  }
  if (who.role >= net::Role::Operator) sign_of(client);
  if (const auto refusal = admit(session_, sender(client), request)) {
    throw std::runtime_error(*refusal);
  }
  const bool taken = server::submit(
      session_,
      std::move(request.request),
      [reply](const json& body) { reply.success(body); },
      [reply](const std::string& refusal) { reply.failure(refusal); },
      who.label());
  if (!taken) reply.failure(kBusy);
}

void Bridge::add_services() {
  // Each throws on a bad request; the hub turns that into the call's failure.
  using Action = std::function<void(const json&, const std::string& who)>;
  const auto heed_driver = [this](ClientId client) {
    if (const auto refusal = admit_deed(session_, sender(client))) {
      throw std::runtime_error(*refusal);
    }
  };
  using Fields = std::vector<std::string_view>;
  const auto add = [this, heed_driver](const char* name, Fields fields, Action action) {
    hub_.add_service(name,
                     [this, heed_driver, fields = std::move(fields), action = std::move(action)](
                         ClientId client, const json& body, const ServiceReply& reply) {
                       heed_driver(client);
                       JsonReader(body, "").only(fields);
                       action(body, hub_.who(client).label());
                       reply.success({{"ok", true}});
                     });
  };
  hub_.add_service(
      "/request",
      [this](ClientId client, const json& body, const ServiceReply& reply) {
        submit(client, stamped_request_from_json(session_, body), reply);
      },
      net::Role::Viewer);
  hub_.add_service("/lease", [this](ClientId client, const json& body, const ServiceReply& reply) {
    reply.success(lease_action(session_, sender(client), body));
  });
  hub_.add_service(
      "/clock",
      [](ClientId, const json& body, const ServiceReply& reply) {
        JsonReader(body, "").only({});
        reply.success({{"ok", true}, {"now", clock_seconds(StickWatch::Clock::now())}});
      },
      net::Role::Viewer);
  hub_.add_service("/watch", [this](ClientId client, const json& body, const ServiceReply& reply) {
    JsonReader(body, "").only({});
    sign_of(client);
    reply.success({{"ok", true}});
  });
  hub_.add_service("/check_goal", [this](ClientId, const json& body, const ServiceReply& reply) {
    if (!session_.may_look_at_goals()) {
      reply.failure(kBusy);
      return;
    }
    reply.success(goal_check_json(session_, body));
  });
  hub_.add_service(
      "/load", [this, heed_driver](ClientId client, const json& body, const ServiceReply& reply) {
        heed_driver(client);
        if (!loads_.load(body, answer_when_loaded(reply))) return reply.failure(kBusy);
        tell_deed(session_, hub_.who(client).label(), "loads another run");
      });
  hub_.add_service(
      "/reset", [this, heed_driver](ClientId client, const json& body, const ServiceReply& reply) {
        heed_driver(client);
        JsonReader(body, "").only({});
        if (!loads_.reset(answer_when_loaded(reply))) return reply.failure(kBusy);
        tell_deed(session_, hub_.who(client).label(), "resets the run");
      });
  const auto heed_pace = [this] {
    if (const auto refusal = session_.pace_refusal()) throw std::runtime_error(*refusal);
  };
  add("/pause", {}, [this, heed_pace](const json&, const std::string& who) {
    heed_pace();
    pause(session_, true, who);
  });
  add("/start", {"x", "y", "heading"}, [this](const json& body, const std::string&) {
    if (const auto refusal = set_start(session_, body)) throw std::runtime_error(*refusal);
  });
  add("/play", {}, [this](const json&, const std::string& who) { pause(session_, false, who); });
  add("/arm", {"armed"}, [this](const json& body, const std::string& who) {
    const JsonReader in(body, "");
    if (!in.has("armed")) in.fail("armed", "must be true or false");
    if (const auto refusal = session_.arm(in.flag_or("armed", false), who)) {
      throw std::runtime_error(*refusal);
    }
  });
  add("/step", {"ticks"}, [this, heed_pace](const json& body, const std::string& who) {
    heed_pace();
    const JsonReader in(body, "");
    if (!session_.state().pace.paused) session_.credits.pause = who;
    session_.single_step(static_cast<std::uint32_t>(in.whole_or("ticks", 1, 1'000'000)));
  });
  add("/speed", {"speed"}, [this, heed_pace](const json& body, const std::string&) {
    heed_pace();
    JsonReader(body, "").number("speed");
    session_.set_speed(pace_from_json(body, "speed", 1));
  });
}

/// The frame with its news, which most frames omit.
std::shared_ptr<const std::string> Bridge::with_news(const Frame& frame) {
  algo::Telemetry t = frame.telemetry;
  t.words_fresh = true;
  t.legend_fresh = true;
  return shared(text_of(encoder_.encode(t)));
}

void Bridge::publish_frame(const FrameRef& frame) {
  const algo::Telemetry& t = frame->telemetry;
  const std::uint64_t time_ns = now_ns();
  const auto now = std::chrono::steady_clock::now();
  hub_.broadcast_time(time_ns, now);  // first: it is sent with the frame
  if (hub_.wanted(telemetry_)) {
    // True if frames skipped since the last one sent had news.
    const bool passed_over =
        (!t.words_fresh && t.words != told_words_) || (!t.legend_fresh && t.legend != told_legend_);
    hub_.publish(telemetry_,
                 time_ns,
                 passed_over ? with_news(*frame) : shared(text_of(encoded(*frame).bytes())));
    told_words_ = t.words;
    told_legend_ = t.legend;
  }
  const auto publish = [&](ChannelId channel, auto encode) {
    if (hub_.wanted(channel)) hub_.publish(channel, time_ns, shared(encode()));
  };
  if (t.scene.fresh) {
    publish(scan_, [&] { return laser_scan_json(t); });
    publish(filtered_, [&] { return text_of(encoder_.encode(t.scene.scan)); });
  }
  publish(tf_, [&] { return transforms_json(t); });
  publish(odom_, [&] { return odometry_json(t); });
  publish(layers_, [&] { return layers_json(t); });
  publish(goal_, [&] { return goal_json(t); });
  const PathTrail& path = session_.path();
  if (path.changes() != path_published_ && now - path_sent_ >= kPathPeriod) {
    path_published_ = path.changes();
    path_sent_ = now;
    publish(trajectory_, [&] { return path.message(t.observation.stamp); });
  }
}

void Bridge::state_changed() {
  state_waits_ = true;
  flush();
}

/// The state of a world of two thousand obstacles takes milliseconds to write. Changes in quick
/// succession are sent together, so that this takes at most a tenth of the io thread's time.
void Bridge::flush() {
  const auto begin = std::chrono::steady_clock::now();
  if (!state_waits_ || begin < state_due_) return;
  state_waits_ = false;
  publish_state();
  const auto end = std::chrono::steady_clock::now();
  state_due_ = end + kStateShare * (end - begin);
}

void Bridge::publish_state() {
  const std::uint64_t time_ns = now_ns();
  hub_.publish(state_, time_ns, shared(dump_json(state_json(session_))));
  hub_.publish(obstacles_,
               time_ns,
               shared(obstacles_json(static_cast<double>(time_ns) * 1e-9, session_.obstacles())));
  if (told_parameters_ != session_.state().asked.parameters) {
    told_parameters_ = session_.state().asked.parameters;
    gains_.follow();
    hub_.parameters_changed();
  }
}

}  // namespace server
