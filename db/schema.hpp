// db/schema.hpp: the tables of a run store, and the check of its version.
#pragma once

#include "db/sqlite.hpp"

namespace db::detail {

/// Sets up an empty database, and brings one of the version before up to date, in one transaction.
/// Throws DatabaseError with Trouble::Outdated for one that an older program wrote, and StoreError
/// for one of a newer or of another program. These files stay unchanged.
void set_up(Connection& connection);

/// Throws the same errors for a database that this program cannot read.
void require_readable(const Connection& connection);

}  // namespace db::detail
