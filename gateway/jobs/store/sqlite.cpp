#include "gateway/jobs/store/sqlite.hpp"

#include <sqlite3.h>

namespace kinebus {
namespace {

StoreError error_of(sqlite3* db) {
  const int code = db != nullptr ? sqlite3_errcode(db) : SQLITE_CANTOPEN;
  StoreError error{StoreError::Kind::kDisk, db != nullptr
                                                ? say("the job store's database: %1", sqlite3_errmsg(db))
                                                : say("the job store's database cannot be opened")};
  switch (code & 0xFF) {
    case SQLITE_FULL:
      error = {StoreError::Kind::kDiskFull, say("the disk is full")};
      break;
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
      error.kind = StoreError::Kind::kReadOnly;
      break;
    default:
      break;
  }
  return error;
}

}  // namespace

void Database::Close::operator()(sqlite3* db) const {
  sqlite3_close_v2(db);
}

Result<Database, StoreError> Database::open(const std::filesystem::path& path) {
  Database database;
  sqlite3* db = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  database.db_.reset(db);
  if (code != SQLITE_OK) return Error<StoreError>(error_of(db));
  // Every transaction is on the disk, its folder entry too, before it counts as done: power may go at any
  // moment.
  if (const auto set = database.run("PRAGMA journal_mode=TRUNCATE; PRAGMA synchronous=EXTRA;"); !set)
    return Error<StoreError>(set.error());
  return database;
}

Result<void, StoreError> Database::run(const char* sql) {
  if (sqlite3_exec(db_.get(), sql, nullptr, nullptr, nullptr) == SQLITE_OK) return {};
  return Error<StoreError>(error_of(db_.get()));
}

bool Database::sound() {
  Statement check(*this, "PRAGMA quick_check(1)");
  return check.step() && check.text(0) == "ok";
}

std::int64_t Database::last_id() const {
  return sqlite3_last_insert_rowid(db_.get());
}

Database::Statement::Statement(Database& database, const char* sql) : db_(database.db_.get()) {
  result_ = sqlite3_prepare_v2(db_, sql, -1, &statement_, nullptr);
}

Database::Statement::~Statement() {
  sqlite3_finalize(statement_);
}

Database::Statement& Database::Statement::bind(std::string_view text) {
  // No text at all would be NULL, which equals nothing.
  sqlite3_bind_text(statement_, next_++, text.empty() ? "" : text.data(), static_cast<int>(text.size()),
                    SQLITE_TRANSIENT);
  return *this;
}
Database::Statement& Database::Statement::bind_blob(std::string_view bytes) {
  sqlite3_bind_blob(statement_, next_++, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
  return *this;
}
Database::Statement& Database::Statement::bind(std::int64_t value) {
  sqlite3_bind_int64(statement_, next_++, value);
  return *this;
}
Database::Statement& Database::Statement::bind(double value) {
  sqlite3_bind_double(statement_, next_++, value);
  return *this;
}

bool Database::Statement::step() {
  if (statement_ == nullptr) return false;
  result_ = sqlite3_step(statement_);
  return result_ == SQLITE_ROW;
}

Result<void, StoreError> Database::Statement::finish() {
  while (step()) continue;
  return error();
}

Result<void, StoreError> Database::Statement::error() const {
  if (result_ == SQLITE_OK || result_ == SQLITE_ROW || result_ == SQLITE_DONE) return {};
  return Error<StoreError>(error_of(db_));
}

std::string Database::Statement::text(int column) const {
  const void* bytes = sqlite3_column_blob(statement_, column);
  const int size = sqlite3_column_bytes(statement_, column);
  return bytes != nullptr ? std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(size)) : "";
}
std::int64_t Database::Statement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}
double Database::Statement::real(int column) const {
  return sqlite3_column_double(statement_, column);
}
bool Database::Statement::null(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

}  // namespace kinebus
