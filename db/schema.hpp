// db/schema.hpp: the tables of a run store, and which files are one of today's.
#pragma once

#include "db/sqlite.hpp"

namespace db::detail {

/// Sets up an empty database, in one transaction. Throws DatabaseError of Trouble::Outdated for one
/// that an older program wrote, StoreError for one of a newer or of another program: all stay as
/// they are.
void set_up(Connection& connection);

/// Throws the same for a database that this program cannot read as it is.
void require_readable(const Connection& connection);

}  // namespace db::detail
