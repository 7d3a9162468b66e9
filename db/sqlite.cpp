// db/sqlite.cpp: SQLite with RAII, and errors as sentences.
#include "db/sqlite.hpp"

#include <array>
#include <charconv>
#include <limits>

#include <sqlite3.h>

namespace db::detail {

namespace {

// Short: the database thread has other work meanwhile, and the io thread reads.
constexpr int kBusyTimeoutMs = 100;

[[noreturn]] void fail(int code, sqlite3* connection, const std::string& path) {
  const std::string detail = connection == nullptr ? "out of memory" : sqlite3_errmsg(connection);
  const std::string store = "The run store " + path;
  switch (code & 0xFF) {
    case SQLITE_FULL:
      throw DatabaseError("The disk is full: the run store " + path + " could not grow.",
                          Trouble::Full);
    case SQLITE_CANTOPEN:
      throw DatabaseError(
          "Cannot open the run store " + path + ": its folder is missing or may not be written.",
          Trouble::Refused);
    case SQLITE_READONLY:
    case SQLITE_PERM:
      throw DatabaseError(store + " may not be written.", Trouble::Refused);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw DatabaseError(store + " is held by another program.", Trouble::Busy);
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw DatabaseError(store + " is damaged or not a database (" + detail + ").",
                          Trouble::Damaged);
    case SQLITE_IOERR:
      throw DatabaseError("The disk failed under the run store " + path + " (" + detail + ").");
    default:
      throw DatabaseError(store + " failed: " + detail + ".");
  }
}

std::string uri_of(const std::string& path, bool immutable) {
  std::string uri = "file:";
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#') {
      const auto* digits = "0123456789ABCDEF";
      uri += '%';
      uri += digits[static_cast<unsigned char>(c) >> 4U];
      uri += digits[static_cast<unsigned char>(c) & 15U];
    } else {
      uri += c;
    }
  }
  return immutable ? uri + "?immutable=1" : uri;
}

}  // namespace

void Statement::Finalizer::operator()(sqlite3_stmt* statement) const noexcept {
  sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* connection, std::string path, std::string_view sql)
    : connection_(connection), path_(std::move(path)) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(connection,
                                      sql.data(),
                                      static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT,
                                      &statement,
                                      nullptr);
  statement_.reset(statement);
  check(code);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) {
    fail(code, connection_, path_);
  }
}

Statement& Statement::reset() {
  sqlite3_reset(statement_.get());  // repeats the last step's error, already thrown
  bound_ = 0;
  return *this;
}

Statement& Statement::operator<<(std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), ++bound_, value));
  return *this;
}
Statement& Statement::operator<<(double value) {
  check(sqlite3_bind_double(statement_.get(), ++bound_, value));
  return *this;
}
Statement& Statement::operator<<(std::string_view value) {
  const char* text = value.data() == nullptr ? "" : value.data();
  check(sqlite3_bind_text64(
      statement_.get(), ++bound_, text, value.size(), SQLITE_STATIC, SQLITE_UTF8));
  return *this;
}
Statement& Statement::operator<<(std::span<const std::byte> value) {
  check(sqlite3_bind_blob64(statement_.get(), ++bound_, value.data(), value.size(), SQLITE_STATIC));
  return *this;
}
Statement& Statement::skip() {
  check(sqlite3_bind_null(statement_.get(), ++bound_));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    // The message belongs to this error only until the reset.
    try {
      fail(code, connection_, path_);
    } catch (...) {
      reset();
      throw;
    }
  }
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double Statement::number(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return sqlite3_column_double(statement_.get(), column);
}
std::string Statement::text(int column) const {
  const auto bytes = blob(column);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
std::string Statement::exact_text(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_FLOAT) return text(column);
  std::array<char, 32> digits{};
  const auto written = std::to_chars(digits.begin(), digits.end(), number(column));
  return {digits.begin(), written.ptr};
}
std::span<const std::byte> Statement::blob(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {static_cast<const std::byte*>(data), static_cast<std::size_t>(size)};
}

void Connection::Closer::operator()(sqlite3* connection) const noexcept {
  sqlite3_close_v2(connection);
}

Connection::Connection(const std::string& path, Mode mode) : path_(path) {
  const bool write = mode == Mode::Write;
  const int flags = (write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY) |
                    SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_URI;
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(
      uri_of(path, mode == Mode::ReadImmutable).c_str(), &connection, flags, nullptr);
  connection_.reset(connection);
  if (code != SQLITE_OK) fail(code, connection, path_);
  sqlite3_extended_result_codes(connection, 1);
  sqlite3_busy_timeout(connection, kBusyTimeoutMs);
}

void Connection::execute(const std::string& sql) const {
  const int code = sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code, connection_.get(), path_);
}

std::int64_t Connection::query_integer(std::string_view sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

bool Connection::in_transaction() const {
  return sqlite3_get_autocommit(connection_.get()) == 0;
}

void Connection::roll_back() const noexcept {
  if (in_transaction()) sqlite3_exec(connection_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

}  // namespace db::detail
