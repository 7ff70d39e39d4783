#include "gateway/io/tls_stream.hpp"

#include <fcntl.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <utility>

#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;
constexpr int kValidYears = 30;
/// Records may carry nothing for the session (key updates, a hello in pieces), and OpenSSL goes on to the
/// next one by itself, as long as any comes. A record takes two of these, a handshake some ten.
constexpr int kReadsAtOnce = 32;

std::string openssl_words(const std::string& what) {
  std::array<char, 256> text{};
  ERR_error_string_n(ERR_get_error(), text.data(), text.size());
  ERR_clear_error();
  return what + ": " + text.data();
}

std::string fingerprint_of(X509* certificate) {
  std::array<unsigned char, 32> digest{};
  unsigned size = 0;
  if (certificate == nullptr || X509_digest(certificate, EVP_sha256(), digest.data(), &size) != 1) return {};
  return joblink::to_hex({reinterpret_cast<const char*>(digest.data()), size});
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File create(const fs::path& path, mode_t mode) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode);
  return File(fd < 0 ? nullptr : ::fdopen(fd, "w"));
}

/// A key and a certificate signed by itself.
std::string make_identity(const fs::path& certificate_path, const fs::path& key_path) {
  const std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)> key(EVP_EC_gen("P-256"), &EVP_PKEY_free);
  const std::unique_ptr<X509, void (*)(X509*)> certificate(X509_new(), &X509_free);
  if (!key || !certificate) return openssl_words("making a key");
  ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), 1);
  X509_set_version(certificate.get(), 2);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), 0);
  X509_time_adj_ex(X509_getm_notAfter(certificate.get()), kValidYears * 365, 0, nullptr);
  X509_set_pubkey(certificate.get(), key.get());
  X509_NAME* name = X509_get_subject_name(certificate.get());
  static constexpr unsigned char kName[] = "kinebus gateway";
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, kName, sizeof kName - 1, -1, 0);
  X509_set_issuer_name(certificate.get(), name);
  if (X509_sign(certificate.get(), key.get(), EVP_sha256()) == 0)
    return openssl_words("signing the certificate");
  const File key_file = create(key_path, 0600);
  if (!key_file ||
      PEM_write_PrivateKey(key_file.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1)
    return key_path.string() + " cannot be written";
  const File certificate_file = create(certificate_path, 0644);
  if (!certificate_file || PEM_write_X509(certificate_file.get(), certificate.get()) != 1)
    return certificate_path.string() + " cannot be written";
  return {};
}

/// The socket under TLS: reads so often at once, then says that nothing has come.
struct BoundedSocket {
  int fd = -1;
  int reads_left = 0;

  static BoundedSocket& of(BIO* bio) { return *static_cast<BoundedSocket*>(BIO_get_data(bio)); }
  static int read(BIO* bio, char* into, int size) {
    BoundedSocket& socket = of(bio);
    BIO_clear_retry_flags(bio);
    ssize_t count = -1;
    errno = EAGAIN;
    if (socket.reads_left > 0) {
      --socket.reads_left;
      count = ::recv(socket.fd, into, static_cast<std::size_t>(size), 0);
    }
    if (count < 0 && BIO_sock_should_retry(-1) != 0) BIO_set_retry_read(bio);
    if (count == 0) BIO_set_flags(bio, BIO_FLAGS_IN_EOF);
    return static_cast<int>(count);
  }
  static int write(BIO* bio, const char* from, int size) {
    BIO_clear_retry_flags(bio);
    const ssize_t count = ::send(of(bio).fd, from, static_cast<std::size_t>(size), MSG_NOSIGNAL);
    if (count < 0 && BIO_sock_should_retry(-1) != 0) BIO_set_retry_write(bio);
    return static_cast<int>(count);
  }
  static long control(BIO* bio, int what, long, void*) {
    if (what == BIO_CTRL_EOF) return BIO_test_flags(bio, BIO_FLAGS_IN_EOF) != 0 ? 1 : 0;
    return what == BIO_CTRL_FLUSH ? 1 : 0;
  }
  static const BIO_METHOD* method() {
    static const std::unique_ptr<BIO_METHOD, void (*)(BIO_METHOD*)> kMethod = [] {
      std::unique_ptr<BIO_METHOD, void (*)(BIO_METHOD*)> made(
          BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "bounded socket"), &BIO_meth_free);
      BIO_meth_set_read(made.get(), &read);
      BIO_meth_set_write(made.get(), &write);
      BIO_meth_set_ctrl(made.get(), &control);
      return made;
    }();
    return kMethod.get();
  }
};

class TlsStream : public ByteStream {
 public:
  TlsStream(std::shared_ptr<SSL_CTX> context, int fd, bool server)
      : context_(std::move(context)), socket_{.fd = fd}, ssl_(SSL_new(context_.get())) {
    BIO* const bio = BIO_new(BoundedSocket::method());
    BIO_set_data(bio, &socket_);
    BIO_set_init(bio, 1);
    SSL_set_bio(ssl_, bio, bio);
    if (server)
      SSL_set_accept_state(ssl_);
    else
      SSL_set_connect_state(ssl_);
  }
  ~TlsStream() override {
    // Said once, without waiting: the other side need not hear it.
    if (!failed_) SSL_shutdown(ssl_);
    ERR_clear_error();
    SSL_free(ssl_);
    ::close(socket_.fd);
  }
  TlsStream(const TlsStream&) = delete;
  TlsStream& operator=(const TlsStream&) = delete;

  int fd() const override { return socket_.fd; }
  std::uint32_t interest(bool output_waits) const override {
    // TLS may need to write before it can read (hand-shake, key update), and the other way round.
    std::uint32_t bits = EPOLLIN;
    if (read_wants_write_ || (output_waits && !write_wants_read_)) bits |= EPOLLOUT;
    return bits;
  }
  Moved read(std::span<std::uint8_t> buffer) override {
    std::size_t count = 0;
    socket_.reads_left = kReadsAtOnce;
    const int result = SSL_read_ex(ssl_, buffer.data(), buffer.size(), &count);
    const int error = result == 1 ? SSL_ERROR_NONE : SSL_get_error(ssl_, result);
    read_wants_write_ = error == SSL_ERROR_WANT_WRITE;
    return moved(error, count);
  }
  Moved write(std::span<const std::uint8_t> bytes) override {
    std::size_t count = 0;
    socket_.reads_left = kReadsAtOnce;
    const int result = SSL_write_ex(ssl_, bytes.data(), bytes.size(), &count);
    const int error = result == 1 ? SSL_ERROR_NONE : SSL_get_error(ssl_, result);
    write_wants_read_ = error == SSL_ERROR_WANT_READ;
    return moved(error, count);
  }
  bool buffered() const override { return SSL_pending(ssl_) > 0; }
  std::string closed_reason() const override { return reason_; }

 private:
  Moved moved(int error, std::size_t count) {
    if (error == SSL_ERROR_NONE) return {count, false};
    if (error == SSL_ERROR_WANT_READ || error == SSL_ERROR_WANT_WRITE) {
      ERR_clear_error();
      return {};
    }
    failed_ = error != SSL_ERROR_ZERO_RETURN;
    if (failed_) reason_ = openssl_words("TLS");
    return {0, true};
  }

  std::shared_ptr<SSL_CTX> context_;  ///< what it expects of the other side lives with it
  BoundedSocket socket_;
  SSL* ssl_;
  std::string reason_;
  bool read_wants_write_ = false, write_wants_read_ = false, failed_ = false;
};

/// The hand-shake with anybody else fails, before the token is said.
int verify_fingerprint(X509_STORE_CTX* store, void* wanted) {
  X509* peer = X509_STORE_CTX_get0_cert(store);
  return fingerprint_of(peer) == *static_cast<const std::string*>(wanted) ? 1 : 0;
}

std::shared_ptr<SSL_CTX> make_context(const SSL_METHOD* method) {
  std::shared_ptr<SSL_CTX> context(SSL_CTX_new(method), &SSL_CTX_free);
  if (!context) return context;
  SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION);
  SSL_CTX_set_mode(context.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  return context;
}

}  // namespace

std::string loose_secret(const fs::path& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0 || (found.st_mode & 077) == 0) return {};
  return path.string() + ": others than its owner may read or write this secret; expected: chmod 600 " +
         path.string();
}

Result<TlsContext, std::string> TlsContext::server(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path certificate = folder / "certificate.pem", key = folder / "key.pem";
  if (!fs::exists(certificate, error) || !fs::exists(key, error))
    if (std::string words = make_identity(certificate, key); !words.empty()) return Error<std::string>(words);
  if (std::string loose = loose_secret(key); !loose.empty()) return Error<std::string>(std::move(loose));
  TlsContext tls;
  tls.is_server_ = true;
  tls.context_ = make_context(TLS_server_method());
  if (!tls.context_ ||
      SSL_CTX_use_certificate_file(tls.context_.get(), certificate.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_use_PrivateKey_file(tls.context_.get(), key.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_check_private_key(tls.context_.get()) != 1)
    return Error<std::string>(openssl_words(folder.string()));
  tls.fingerprint_ = fingerprint_of(SSL_CTX_get0_certificate(tls.context_.get()));
  return tls;
}

Result<TlsContext, std::string> TlsContext::client(std::string fingerprint) {
  std::transform(fingerprint.begin(), fingerprint.end(), fingerprint.begin(),
                 [](char c) { return c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c; });
  std::erase(fingerprint, ':');
  if (fingerprint.size() != 64)
    return Error<std::string>("a fingerprint is 64 hexadecimal digits, as kinebusd prints it when it starts");
  TlsContext tls;
  tls.fingerprint_ = std::move(fingerprint);
  std::shared_ptr<SSL_CTX> context = make_context(TLS_client_method());
  if (!context) return Error<std::string>(openssl_words("TLS"));
  // The expectation lives as long as the context.
  auto wanted = std::make_shared<std::string>(tls.fingerprint_);
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  SSL_CTX_set_cert_verify_callback(context.get(), &verify_fingerprint, wanted.get());
  tls.context_ = std::shared_ptr<SSL_CTX>(context.get(), [context, wanted](SSL_CTX*) {});
  return tls;
}

std::unique_ptr<ByteStream> TlsContext::open(int fd) const {
  return std::make_unique<TlsStream>(context_, fd, is_server_);
}

}  // namespace kinebus
