// db/sqlite.hpp: SQLite with RAII: a connection, prepared statements, and errors as sentences.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace db {

/// The store cannot do the request; what() is a sentence a person can act on.
class StoreError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The kind of a database failure, as far as it matters for the remedy.
enum class Trouble : std::uint8_t {
  Busy,      // another program holds it: nothing is lost, try again
  Full,      // the disk is full
  Damaged,   // the file is damaged, or is not a database
  Outdated,  // an older program wrote it
  Refused,   // it may not be opened or written, or another server writes it
  Failed,    // anything else, such as a failing disk
};

/// The database itself failed: disk full, not readable, locked by another program.
class DatabaseError : public StoreError {
 public:
  explicit DatabaseError(const std::string& sentence, Trouble trouble = Trouble::Failed)
      : StoreError(sentence), trouble_(trouble) {}
  Trouble trouble() const { return trouble_; }

 private:
  Trouble trouble_;
};

namespace detail {

/// One prepared statement. Bound text and bytes must live until the next reset().
class Statement {
 public:
  Statement() = default;
  Statement(sqlite3* connection, std::string path, std::string_view sql);

  Statement& reset();
  /// Binds the next parameter, starting from the first after a reset().
  Statement& operator<<(std::int64_t value);
  Statement& operator<<(std::uint64_t value) { return *this << static_cast<std::int64_t>(value); }
  Statement& operator<<(double value);  // NaN, which SQLite does not keep, becomes NULL
  Statement& operator<<(std::string_view value);
  Statement& operator<<(std::span<const std::byte> value);
  /// Binds NULL to the next parameter.
  Statement& skip();

  bool step();  // true: a row is available
  void run();   // step() to the end, then reset

  std::int64_t integer(int column) const;
  std::uint64_t count(int column) const { return static_cast<std::uint64_t>(integer(column)); }
  double number(int column) const;  // NULL is NaN
  std::string text(int column) const;
  /// The value as text that reads back as the same value; NULL is empty.
  std::string exact_text(int column) const;
  std::span<const std::byte> blob(int column) const;  // until the next step or reset

 private:
  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  void check(int code) const;

  std::unique_ptr<sqlite3_stmt, Finalizer> statement_{};
  sqlite3* connection_ = nullptr;
  std::string path_{};
  int bound_ = 0;
};

/// Resets a statement at the end of a scope: a reader must not hold its snapshot any longer.
class ResetLater {
 public:
  explicit ResetLater(Statement& statement) : statement_(statement) {}
  ~ResetLater() { statement_.reset(); }
  ResetLater(const ResetLater&) = delete;
  ResetLater& operator=(const ResetLater&) = delete;

 private:
  Statement& statement_;
};

/// One connection, used by one thread at a time.
class Connection {
 public:
  enum class Mode : std::uint8_t { Write, Read, ReadImmutable };
  /// Throws DatabaseError if the file cannot be opened; Write creates a missing file.
  Connection(const std::string& path, Mode mode);

  const std::string& path() const { return path_; }
  Statement prepare(std::string_view sql) const { return {connection_.get(), path_, sql}; }
  void execute(const std::string& sql) const;
  std::int64_t query_integer(std::string_view sql) const;
  bool in_transaction() const;
  void roll_back() const noexcept;  // no effect without a transaction

 private:
  struct Closer {
    void operator()(sqlite3* connection) const noexcept;
  };
  std::unique_ptr<sqlite3, Closer> connection_{};
  std::string path_{};
};

}  // namespace detail
}  // namespace db
