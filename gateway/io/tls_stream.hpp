#pragma once
// TLS 1.2 and later over TCP, without blocking. The gateway proves itself by its own certificate, whose
// fingerprint clients remember; the client proves itself by a token within the encrypted link.

#include <filesystem>
#include <memory>
#include <string>

#include "gateway/io/byte_stream.hpp"
#include "gateway/result.hpp"

struct ssl_ctx_st;

namespace kinebus {

/// Words for the user when others than its owner may read or write the file; empty: it is the owner's alone.
std::string loose_secret(const std::filesystem::path& path);

class TlsContext {
 public:
  /// For the gateway: certificate and key are made in `folder` when they are not there. Error: in words.
  static Result<TlsContext, std::string> server(const std::filesystem::path& folder);
  /// For a client: accepts only the certificate with this SHA-256 fingerprint (hexadecimal).
  static Result<TlsContext, std::string> client(std::string fingerprint);

  /// SHA-256 of the gateway's certificate, hexadecimal.
  const std::string& fingerprint() const { return fingerprint_; }
  /// Takes over a connected, non-blocking socket.
  std::unique_ptr<ByteStream> open(int fd) const;

 private:
  std::shared_ptr<ssl_ctx_st> context_;
  std::string fingerprint_;
  bool is_server_ = false;
};

}  // namespace kinebus
