#include "gateway/fleet/database.hpp"

#include <libpq-fe.h>

#include <cstdlib>
#include <utility>

namespace kinebus::fleet {
namespace {

constexpr std::string_view kUniqueViolation = "23505", kNoSuchColumn = "42703", kNoSuchTable = "42P01";

/// PostgreSQL's words end in a line's end, and may have more lines.
std::string words_of(const char* message) {
  std::string words(message == nullptr ? "" : message);
  while (!words.empty() && words.back() == '\n') words.pop_back();
  for (char& c : words)
    if (c == '\n') c = ' ';
  return "database: " + words;
}

}  // namespace

Parameter Parameter::bytes(std::string_view value) {
  Parameter parameter{std::string(value)};
  parameter.binary = true;
  return parameter;
}

void Rows::Clear::operator()(pg_result* result) const {
  PQclear(result);
}
Rows::Rows(pg_result* result) : result_(result) {}
int Rows::count() const {
  return PQntuples(result_.get());
}
bool Rows::null(int row, int column) const {
  return PQgetisnull(result_.get(), row, column) != 0;
}
std::string Rows::text(int row, int column) const {
  return {PQgetvalue(result_.get(), row, column),
          static_cast<std::size_t>(PQgetlength(result_.get(), row, column))};
}
std::int64_t Rows::integer(int row, int column) const {
  return std::strtoll(PQgetvalue(result_.get(), row, column), nullptr, 10);
}
double Rows::real(int row, int column) const {
  return std::strtod(PQgetvalue(result_.get(), row, column), nullptr);
}
std::string Rows::bytes(int row, int column) const {
  std::size_t size = 0;
  const std::string escaped = text(row, column);
  unsigned char* plain = PQunescapeBytea(reinterpret_cast<const unsigned char*>(escaped.c_str()), &size);
  if (plain == nullptr) throw std::bad_alloc();
  std::string bytes(reinterpret_cast<const char*>(plain), size);
  PQfreemem(plain);
  return bytes;
}

void Database::Close::operator()(pg_conn* connection) const {
  PQfinish(connection);
}

pg_conn* Database::connection() {
  if (connection_ != nullptr && PQstatus(connection_.get()) != CONNECTION_OK) connection_.reset();
  if (connection_ == nullptr) {
    prepared_.clear();
    // What is said in `where_` comes last, and so counts.
    const char* names[] = {"connect_timeout", "tcp_user_timeout", "application_name", "dbname", nullptr};
    const char* values[] = {"5", "20000", "kinebus-fleet", where_.c_str(), nullptr};
    connection_.reset(PQconnectdbParams(names, values, 1));
    if (connection_ == nullptr) throw std::bad_alloc();
    if (PQstatus(connection_.get()) != CONNECTION_OK) {
      const std::string words = words_of(PQerrorMessage(connection_.get()));
      connection_.reset();
      throw DatabaseError(words);
    }
    PQsetNoticeProcessor(
        connection_.get(), [](void*, const char*) {}, nullptr);
  }
  return connection_.get();
}

pg_result* Database::checked(pg_result* result) {
  const ExecStatusType status = PQresultStatus(result);
  if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) return result;
  const char* given = PQresultErrorField(result, PG_DIAG_SQLSTATE);
  const std::string code = given == nullptr ? "" : given;
  std::string words = words_of(PQerrorMessage(connection_.get()));
  PQclear(result);
  if (code == kUniqueViolation) throw NotUnique(words);
  if (code == kNoSuchColumn || code == kNoSuchTable)
    words += "; expected: the tables of this version, which 'kinebus-fleet init' makes";
  throw DatabaseError(words);
}

/// Planning takes longer than most of these statements.
const char* Database::prepared(const std::string& sql) {
  pg_conn* const to = connection();
  auto found = prepared_.find(sql);
  if (found == prepared_.end()) {
    const std::string name = "s" + std::to_string(prepared_.size());
    PQclear(checked(PQprepare(to, name.c_str(), sql.c_str(), 0, nullptr)));
    found = prepared_.emplace(sql, name).first;
  }
  return found->second.c_str();
}

Rows Database::run(const std::string& sql, const std::vector<Parameter>& parameters) {
  std::vector<const char*> values;
  std::vector<int> lengths, formats;
  for (const Parameter& parameter : parameters) {
    values.push_back(parameter.text.c_str());
    lengths.push_back(static_cast<int>(parameter.text.size()));
    formats.push_back(parameter.binary ? 1 : 0);
  }
  const char* const name = prepared(sql);
  return Rows(checked(PQexecPrepared(connection_.get(), name, static_cast<int>(values.size()), values.data(),
                                     lengths.data(), formats.data(), 0)));
}

void Database::run_all(const char* sql) {
  pg_conn* const to = connection();
  PQclear(checked(PQexec(to, sql)));
}

}  // namespace kinebus::fleet
