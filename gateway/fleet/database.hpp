#pragma once
// PostgreSQL as values: one connection that is made anew when it broke, statements with parameters, rows of
// text.

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

struct pg_conn;
struct pg_result;

namespace kinebus::fleet {

/// The database does not answer, or refuses; in words. Whether the statement was done is not known.
struct DatabaseError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Another row has this place already: a rule of the schema.
struct NotUnique : DatabaseError {
  using DatabaseError::DatabaseError;
};

struct Parameter {
  Parameter(std::string text_) : text(std::move(text_)) {}        // NOLINT(google-explicit-constructor)
  Parameter(const char* text_) : text(text_) {}                   // NOLINT(google-explicit-constructor)
  Parameter(std::int64_t value) : text(std::to_string(value)) {}  // NOLINT(google-explicit-constructor)
  Parameter(int value) : text(std::to_string(value)) {}           // NOLINT(google-explicit-constructor)
  Parameter(double value) : text(std::to_string(value)) {}        // NOLINT(google-explicit-constructor)
  Parameter(bool value) : text(value ? "t" : "f") {}              // NOLINT(google-explicit-constructor)
  static Parameter bytes(std::string_view value);
  std::string text;
  bool binary = false;
};

class Rows {
 public:
  explicit Rows(pg_result* result);
  int count() const;
  bool null(int row, int column) const;
  std::string text(int row, int column) const;
  std::int64_t integer(int row, int column) const;
  double real(int row, int column) const;
  bool truth(int row, int column) const { return text(row, column) == "t"; }
  /// Of a bytea.
  std::string bytes(int row, int column) const;

 private:
  struct Clear {
    void operator()(pg_result* result) const;
  };
  std::unique_ptr<pg_result, Clear> result_;
};

class Database {
 public:
  /// `where`: as libpq reads it ("host=... dbname=...", or a URI). Connects when it is first asked.
  explicit Database(std::string where) : where_(std::move(where)) {}
  /// The statement is prepared when it first comes: it must be one of a few.
  Rows run(const std::string& sql, const std::vector<Parameter>& parameters = {});
  /// Several statements without parameters, as one transaction.
  void run_all(const char* sql);

 private:
  struct Close {
    void operator()(pg_conn* connection) const;
  };
  pg_conn* connection();
  pg_result* checked(pg_result* result);
  const char* prepared(const std::string& sql);

  std::string where_;
  std::unique_ptr<pg_conn, Close> connection_;
  std::unordered_map<std::string, std::string> prepared_;  ///< of this connection: its name by its text
};

}  // namespace kinebus::fleet
