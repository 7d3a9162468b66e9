// db/run_query.hpp: a filter and an order of runs as SQL with its values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "db/records.hpp"
#include "db/sqlite.hpp"

namespace db::detail {

/// SQL and the values of its parameters, in their order.
class RunQuery {
 public:
  /// The filtered runs, in the order, after `cursor`. Gives the columns `id` and `sort_key`.
  static RunQuery page(const RunFilter& filter,
                       const RunOrder& order,
                       const std::optional<std::string>& cursor,
                       std::uint64_t limit);
  /// The number of lines.
  static RunQuery count(const RunFilter& filter, bool grouped);
  /// The number of runs by result.
  static RunQuery results(const RunFilter& filter);
  /// As results(), with the least and the greatest number of each: of the runs in `batch`.
  static RunQuery results_of_batch(const RunFilter& filter, RunId batch);

  /// Prepares the statement and binds the values, which must outlive its use.
  Statement prepare(const Connection& connection) const;

 private:
  using Value = std::variant<std::int64_t, double, std::string>;
  void add(std::string_view sql) { sql_ += sql; }
  void add(std::string_view sql, Value value);
  void add_filter(const RunFilter& filter);
  void add_cursor(const RunOrder& order, const std::string& cursor);

  std::string sql_{};
  std::vector<Value> values_{};
};

/// The cursor after the line of run `id` whose sort key stands in `column`.
std::string cursor_after(const RunOrder& order, RunId id, const Statement& found, int column);

}  // namespace db::detail
