// db/schema.hpp: the tables, and how a database of an older version becomes one of today's.
#pragma once

#include "db/sqlite.hpp"

namespace db::detail {

/// What PRAGMA user_version says of a database this program wrote.
int schema_version();

/// Sets up an empty database or brings an older one up to date, in one transaction. Throws
/// StoreError for a newer version or a database of another program, which stay as they are.
void migrate(Connection& connection);

/// Throws StoreError when the database is not one this program can read as it is.
void require_current(const Connection& connection);

}  // namespace db::detail
