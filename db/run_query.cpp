// db/run_query.cpp: a filter and an order of runs as SQL with its values.
//
// The queries read the table `listing` alone: 20,000 runs are some 5 MB there, and several times
// more as whole rows.
#include "db/run_query.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace db {

namespace {

struct Sort {
  std::string_view name{};
  std::string_view column{};
  bool is_text = false;
};
constexpr auto kSorts = std::to_array<Sort>({{"id", "id"},
                                             {"time", "verdict_time"},
                                             {"outcome", "result", true},
                                             {"scenario", "scenario", true},
                                             {"controller", "controller", true},
                                             {"label", "label", true},
                                             {"kind", "kind", true},
                                             {"seed", "seed"},
                                             {"path_length", "path_length"},
                                             {"min_clearance", "min_clearance"},
                                             {"intrusion", "intrusion"},
                                             {"turning", "turning"}});

const Sort& sort_of(const RunOrder& order) {
  const auto* const found = std::ranges::find(kSorts, order.by, &Sort::name);
  if (found == kSorts.end())
    throw std::invalid_argument("runs cannot be sorted by '" + order.by + "'");
  return *found;
}

/// The number that is all of `text`.
template <typename Number>
std::optional<Number> parsed(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

constexpr std::string_view kLine = "iif(batch = 0, -id, batch)";  // what one line has in common

}  // namespace

std::span<const std::string_view> sort_names() {
  static const auto names = [] {
    std::array<std::string_view, kSorts.size()> out{};
    std::ranges::transform(kSorts, out.begin(), &Sort::name);
    return out;
  }();
  return names;
}

namespace detail {

void RunQuery::add(std::string_view sql, Value value) {
  sql_ += sql;
  values_.push_back(std::move(value));
}

void RunQuery::add_filter(const RunFilter& f) {
  add(" WHERE true");
  if (f.scenario) add(" AND scenario = ?", *f.scenario);
  if (f.controller) add(" AND controller = ?", *f.controller);
  if (f.outcome) add(" AND outcome = ?", *f.outcome);
  if (f.status) add(" AND status = ?", std::string(to_string(*f.status)));
  if (f.result) add(" AND result = ?", *f.result);
  if (f.kind) add(" AND kind = ?", std::string(to_string(*f.kind)));
  if (f.seed) add(" AND seed = ?", static_cast<std::int64_t>(*f.seed));
  if (f.tag) add(" AND instr(tags, ?)", '\n' + *f.tag + '\n');
  if (f.batch) add(" AND batch = ?", *f.batch);
  for (const std::string& word : f.words) add(" AND instr(words, ?)", word);
}

/// Lines after the cursor: without a key they come last, in either order.
void RunQuery::add_cursor(const RunOrder& order, const std::string& cursor) {
  const std::invalid_argument bad("'" + cursor + "' is no cursor of this list");
  const std::size_t colon = cursor.find(':');
  const auto id = parsed<std::int64_t>(std::string_view(cursor).substr(0, colon));
  const Sort& sort = sort_of(order);
  const bool by_id = sort.column == "id";
  if (!id || by_id != (colon == std::string::npos)) throw bad;
  const std::string than = order.descending ? " < ?" : " > ?";
  if (by_id) {
    add(" WHERE id" + than, *id);
    return;
  }
  const std::string key = cursor.substr(colon + 1);
  if (key.empty() && !sort.is_text) {
    add(" WHERE sort_key IS NULL AND id" + than, *id);
    return;
  }
  Value value = key;
  if (!sort.is_text) {
    const auto number = parsed<double>(key);
    const auto whole = parsed<std::int64_t>(key);
    if (!number) throw bad;
    value = whole ? Value(*whole) : Value(*number);
  }
  add(" WHERE (sort_key" + than, value);
  add(" OR (sort_key = ?", value);
  add(" AND id" + than, *id);
  add(sort.is_text ? "))" : ") OR sort_key IS NULL)");
}

RunQuery RunQuery::page(const RunFilter& filter,
                        const RunOrder& order,
                        const std::optional<std::string>& cursor,
                        std::uint64_t limit) {
  const Sort& sort = sort_of(order);
  const bool by_id = sort.column == "id";
  const std::string direction = order.descending ? " DESC" : " ASC";
  RunQuery query;
  query.add("SELECT id, sort_key FROM (SELECT ");
  // SQLite takes the other columns of a group from the row with the greatest id.
  query.add(order.grouped ? "max(id) AS id, " : "id, ");
  query.add(sort.column);
  query.add(" AS sort_key FROM listing");
  query.add_filter(filter);
  if (order.grouped) query.add(" GROUP BY " + std::string(kLine));
  query.add(")");
  if (cursor) query.add_cursor(order, *cursor);
  query.add(" ORDER BY ");
  if (!by_id) query.add("sort_key IS NULL, sort_key" + direction + ", ");
  query.add("id" + direction + " LIMIT ?", static_cast<std::int64_t>(limit));
  return query;
}

RunQuery RunQuery::count(const RunFilter& filter, bool grouped) {
  RunQuery query;
  query.add(grouped ? "SELECT count(DISTINCT " + std::string(kLine) + ")" : "SELECT count(*)");
  query.add(" FROM listing");
  query.add_filter(filter);
  return query;
}

RunQuery RunQuery::results(const RunFilter& filter) {
  RunQuery query;
  query.add("SELECT result, count(*) FROM listing");
  query.add_filter(filter);
  query.add(" GROUP BY result");
  return query;
}

RunQuery RunQuery::results_of_batch(const RunFilter& filter, RunId batch) {
  RunQuery query;
  query.add("SELECT result, count(*), min(id), max(id) FROM listing");
  query.add_filter(filter);
  query.add(" AND id IN (SELECT id FROM run WHERE batch > 0 AND batch = ?) GROUP BY result", batch);
  return query;
}

Statement RunQuery::prepare(const Connection& connection) const {
  Statement statement = connection.prepare(sql_);
  for (const Value& value : values_) {
    std::visit(
        [&](const auto& one) {
          if constexpr (std::is_same_v<std::decay_t<decltype(one)>, std::string>) {
            statement << std::string_view(one);
          } else {
            statement << one;
          }
        },
        value);
  }
  return statement;
}

std::string cursor_after(const RunOrder& order, RunId id, const Statement& found, int column) {
  std::string cursor = std::to_string(id);
  // SQLite's text of a number reads back as the same number only up to 15 digits.
  if (order.by != "id") cursor += ':' + found.exact_text(column);
  return cursor;
}

}  // namespace detail
}  // namespace db
