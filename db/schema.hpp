// db/schema.hpp: the tables of a run store, and the check of its version.
#pragma once

#include <string>

#include "db/sqlite.hpp"

namespace db::detail {

/// Throws DatabaseError with Trouble::Refused for a file that was never a run store: it does not
/// begin as a database, or is one of another program. The file stays unchanged; a missing or an
/// empty one passes.
void refuse_other_files(const std::string& path);

/// Sets up an empty database, and brings one of the version before up to date, in one transaction.
/// Throws DatabaseError with Trouble::Outdated for one that an older program wrote, and StoreError
/// for one of a newer or of another program. These files stay unchanged.
void set_up(Connection& connection);

/// Throws the same errors for a database that this program cannot read.
void require_readable(const Connection& connection);

}  // namespace db::detail
