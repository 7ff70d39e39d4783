#include "tools/cli/link_bench.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

namespace kinebus {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A file of bytes that differ from run to run: an upload that the store knows already would send nothing.
std::string make_file(std::uint64_t size_mib) {
  const auto path =
      std::filesystem::temp_directory_path() / fmt::format("kinebus-bench-{}.gcode", ::getpid());
  std::ofstream out(path, std::ios::binary);
  std::mt19937_64 random(std::random_device{}());
  std::string piece(1U << 20, '\0');
  for (std::uint64_t i = 0; i < size_mib; ++i) {
    for (std::size_t k = 0; k < piece.size(); k += 8) {
      const std::uint64_t word = random();
      std::copy_n(reinterpret_cast<const char*>(&word), 8, piece.data() + k);
    }
    out << piece;
  }
  return path.string();
}

void run_bench(const MachineOptions& options, std::uint64_t size_mib, int round_trips) {
  Client client(options.reach);
  std::vector<double> times_ms;
  for (int i = 0; i < round_trips; ++i) {
    const auto begin = Clock::now();
    joblink::ClientMessage request;
    request.mutable_ping();
    client.ask(std::move(request));
    times_ms.push_back(seconds_since(begin) * 1e3);
  }
  std::sort(times_ms.begin(), times_ms.end());
  fmt::print("round trip  median {:.3f} ms, 99 % {:.3f} ms, worst {:.3f} ms of {}\n",
             times_ms[times_ms.size() / 2], times_ms[times_ms.size() * 99 / 100], times_ms.back(),
             round_trips);

  const std::string file = make_file(size_mib);
  const std::string name = std::filesystem::path(file).filename().string();
  const auto begin = Clock::now();
  client.upload(file, name, [](std::uint64_t, std::uint64_t) {});
  const double took_s = seconds_since(begin);
  std::filesystem::remove(file);
  joblink::ClientMessage request;
  request.mutable_delete_job()->set_name(name);
  client.ask(std::move(request));
  fmt::print("upload      {:.1f} MB/s: {} MiB in {:.2f} s, checked on both sides and on the disk\n",
             static_cast<double>(size_mib) * 1.048576 / took_s, size_mib, took_s);
}

}  // namespace

void add_link_bench(CLI::App& app, const std::shared_ptr<MachineOptions>& options) {
  auto* bench = app.add_subcommand("bench", "Measure the link to the daemon: round trip and upload");
  auto size = std::make_shared<std::uint64_t>(100);
  auto trips = std::make_shared<int>(1000);
  bench->add_option("--mib", *size, "Size of the upload")->check(CLI::Range(1, 4000));
  bench->add_option("--round-trips", *trips)->check(CLI::Range(1, 1'000'000));
  bench->callback([=] { run_bench(*options, *size, *trips); });
}

}  // namespace kinebus
