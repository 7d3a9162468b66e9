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
void require_readable(const Connection& connection);

/// Whether it has the table of gaps, which older ones lack.
bool has_gaps(const Connection& connection);

/// Whether runs may share a document, which those of older databases never do.
bool shares_documents(const Connection& connection);

}  // namespace db::detail
