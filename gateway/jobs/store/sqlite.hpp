#pragma once
// SQLite as values: a connection, statements, and errors as StoreError. Only what the job store needs.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/jobs/store/store_error.hpp"
#include "gateway/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace kinebus {

class Database {
 public:
  /// Opens or makes the file. ":memory:" is a database that is gone with the object.
  static Result<Database, StoreError> open(const std::filesystem::path& path);

  /// One or more statements without parameters and results.
  Result<void, StoreError> run(const char* sql);
  /// Looks through the whole file. False: it is damaged.
  bool sound();
  std::int64_t last_id() const;

  class Statement;

 private:
  struct Close {
    void operator()(sqlite3* db) const;
  };
  std::unique_ptr<sqlite3, Close> db_;
};

/// A prepared statement: bind in order, then step() until false, then look at error().
class Database::Statement {
 public:
  Statement(Database& database, const char* sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(std::string_view text);
  Statement& bind_blob(std::string_view bytes);
  Statement& bind(std::int64_t value);
  Statement& bind(double value);

  bool step();  ///< true: a row is there
  /// Steps to the end without looking at rows.
  Result<void, StoreError> finish();
  Result<void, StoreError> error() const;

  std::string text(int column) const;  ///< also of a blob
  std::int64_t integer(int column) const;
  double real(int column) const;
  bool null(int column) const;

 private:
  sqlite3* db_ = nullptr;
  sqlite3_stmt* statement_ = nullptr;
  int next_ = 1;
  int result_ = 0;
};

}  // namespace kinebus
