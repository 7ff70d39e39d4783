#pragma once
// A store of jobs in a folder of its own.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/jobs/store/tests/temporary_folder.hpp"
#include "protocol/joblink/job_hash.hpp"

namespace kinebus::testing_store {

inline UploadIdentity identity_of(const std::string& name, const std::string& text) {
  return {name, text.size(), joblink::job_hash_of(text)};
}

class JobStoreTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  JobStore::Options options_{.folder = folder_.path() / "jobs", .margin_bytes = 0};
  std::unique_ptr<JobStore> store_ = JobStore::open(options_, 1000);

  void reopen(double now = 2000) {
    store_.reset();
    store_ = JobStore::open(options_, now);
  }
  /// Empty: stored.
  std::string put(const std::string& name, const std::string& text, bool replace = true) {
    const auto begun = store_->begin_upload(identity_of(name, text), replace, 1000);
    if (!begun) return begun.error().words;
    if (begun->stored) return {};
    const auto sent = store_->append(begun->id, begun->received_bytes,
                                     std::string_view(text).substr(begun->received_bytes));
    if (!sent) return sent.error().words;
    const auto done = store_->commit(begun->id, 1234);
    return done ? Sentence() : done.error().words;
  }
};

}  // namespace kinebus::testing_store
