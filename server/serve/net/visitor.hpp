// server/serve/net/visitor.hpp: who sends a request or holds a WebSocket: role, name and address.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace server::net {

/// Each role may do everything that the one before it may. Without a token of the server's,
/// everybody is an admin.
enum class Role : std::uint8_t {
  Nobody,    // has shown no token that is needed
  Viewer,    // sees everything, and may press Stop
  Operator,  // drives, edits the world, sets parameters, starts runs
  Admin,     // deletes what others have made, ends sessions, sees the clients
};

/// "viewer".
std::string_view name(Role role);
/// Why `has` may not do what needs `needed`, and what to do.
std::string role_refusal(Role has, Role needed);

struct Visitor {
  Role role = Role::Nobody;
  std::string address{};  // of the client, even behind a trusted proxy
  std::string name{};     // as the person gave it, cleaned; nothing vouches for it

  /// For others to read: the name, else the address.
  const std::string& label() const { return name.empty() ? address : name; }
};

/// A name that a person gives, made fit to be shown to others: valid UTF-8 without control and
/// direction characters, without space at its ends, of at most 32 characters. May be empty.
std::string clean_name(std::string_view text);

}  // namespace server::net
