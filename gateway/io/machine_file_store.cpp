#include "gateway/io/machine_file_store.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "protocol/host/write_all.hpp"

namespace kinebus {
namespace {

Sentence because(const std::filesystem::path& path) {
  return say("%1: %2", path.string(), std::strerror(errno));
}

}  // namespace

Result<MachineFilePort::Text, Sentence> MachineFileStore::read() {
  if (path_.empty()) return Text{built_in_, {}, false};
  std::ifstream in(path_, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return Error<Sentence>(because(path_));
  const bool writable =
      ::access(path_.c_str(), W_OK) == 0 && ::access(path_.parent_path().c_str(), W_OK) == 0;
  return Text{std::move(text).str(), path_.string(), writable};
}

Result<void, Sentence> MachineFileStore::write(std::string_view text) {
  if (path_.empty())
    return Error<Sentence>(say("this gateway runs with its built-in machine: start it with --machine FILE"));
  const std::filesystem::path fresh = path_.string() + ".new", before = path_.string() + ".before";
  struct stat old {};
  const mode_t mode = ::stat(path_.c_str(), &old) == 0 ? old.st_mode & 0777 : 0644;
  const int fd = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode);
  if (fd < 0) return Error<Sentence>(because(fresh));
  const bool written = write_all(fd, text) && ::fsync(fd) == 0;
  const Sentence failure = written ? Sentence() : because(fresh);
  ::close(fd);
  if (!written) {
    ::unlink(fresh.c_str());
    return Error<Sentence>(failure);
  }
  // A second name for the present file, then the new one takes its place in one step.
  ::unlink(before.c_str());
  [[maybe_unused]] const int linked = ::link(path_.c_str(), before.c_str());
  if (::rename(fresh.c_str(), path_.c_str()) != 0) return Error<Sentence>(because(path_));
  const int folder = ::open(path_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
  return {};
}

}  // namespace kinebus
