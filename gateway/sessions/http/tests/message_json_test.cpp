// Messages as JSON are what protobuf's own writer makes of them; so is the status that all share.

#include <google/protobuf/util/json_util.h>

#include <limits>

#include "gateway/sessions/http/kinebus/message_json.hpp"
#include "gateway/sessions/http/tests/socket_rig.hpp"

namespace kinebus::http {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using nlohmann::json;

json by_protobuf(const Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  EXPECT_TRUE(google::protobuf::util::MessageToJsonString(message, &text, options).ok());
  return json::parse(text);
}

constexpr const char* kTexts[] = {"", "a", "\"in quotes\" \\ and \n\t\x01\x1f/", "\xC3\xA4\xE2\x82\xAC",
                                  "ends\\"};
constexpr double kNumbers[] = {0, -0.0, 1, -2.5, 1e-7, 1e300, 0.1, 1.0 / 3, 123456789.125};

/// Every field of it and of those within, but for the `leaves_out`th of each message; `turn`: with what.
void fill(Message& message, int turn, int leaves_out, int depth = 0) {
  const Descriptor& type = *message.GetDescriptor();
  const auto& r = *message.GetReflection();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (i == leaves_out || (field.real_containing_oneof() != nullptr && (turn + i) % 3 != 0)) continue;
    const bool list = field.is_repeated();
    for (int k = 0; k < (list ? turn % 4 : 1); ++k) {
      const int n = turn + 3 * i + k;
      const auto set = [&](auto one, auto more, auto value) {
        list ? (r.*more)(&message, &field, value) : (r.*one)(&message, &field, value);
      };
      using R = google::protobuf::Reflection;
      switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_INT32:
          set(&R::SetInt32, &R::AddInt32, n % 2 == 0 ? std::numeric_limits<std::int32_t>::min() : n);
          break;
        case FieldDescriptor::CPPTYPE_UINT32:
          set(&R::SetUInt32, &R::AddUInt32, n % 2 == 0 ? std::uint32_t{0xFFFFFFFF} : std::uint32_t{0});
          break;
        case FieldDescriptor::CPPTYPE_INT64:
          set(&R::SetInt64, &R::AddInt64,
              n % 2 == 0 ? std::numeric_limits<std::int64_t>::min() : std::int64_t{n});
          break;
        case FieldDescriptor::CPPTYPE_UINT64:
          set(&R::SetUInt64, &R::AddUInt64, n % 2 == 0 ? ~std::uint64_t{0} : std::uint64_t{7});
          break;
        case FieldDescriptor::CPPTYPE_DOUBLE:
          set(&R::SetDouble, &R::AddDouble, kNumbers[static_cast<std::size_t>(n) % std::size(kNumbers)]);
          break;
        case FieldDescriptor::CPPTYPE_FLOAT:
          set(&R::SetFloat, &R::AddFloat, 0.25F * static_cast<float>(n));
          break;
        case FieldDescriptor::CPPTYPE_BOOL:
          set(&R::SetBool, &R::AddBool, n % 2 == 0);
          break;
        case FieldDescriptor::CPPTYPE_ENUM:
          set(&R::SetEnumValue, &R::AddEnumValue,
              n % 7 == 0 ? 9999 : field.enum_type()->value(n % field.enum_type()->value_count())->number());
          break;
        case FieldDescriptor::CPPTYPE_STRING: {
          const std::string text = kTexts[static_cast<std::size_t>(n) % std::size(kTexts)];
          list ? r.AddString(&message, &field, text) : r.SetString(&message, &field, text);
          break;
        }
        case FieldDescriptor::CPPTYPE_MESSAGE:
          if (depth < 4)
            fill(list ? *r.AddMessage(&message, &field) : *r.MutableMessage(&message, &field), n, leaves_out,
                 depth + 1);
          break;
      }
    }
  }
}

TEST(MessageJson, IsWhatProtobufsOwnWriterMakesOfEveryMessage) {
  joblink::Reply reply;
  joblink::ClientMessage asked;
  joblink::ServerMessage told;
  joblink::Status status;
  for (Message* const message : std::initializer_list<Message*>{&reply, &asked, &told, &status})
    for (int turn = 0; turn < 40; ++turn) {
      message->Clear();
      fill(*message, turn, turn % 8 - 1);
      const std::string text = to_json(*message);
      const json read = json::parse(text, nullptr, false);
      ASSERT_FALSE(read.is_discarded()) << text;
      ASSERT_EQ(read, by_protobuf(*message)) << message->GetTypeName() << ", turn " << turn;
    }
}

joblink::Status asked_by_the_job_link(HttpRig& rig) {
  Caller caller(rig.server, rig.link.machine.now);
  caller.become({.role = Role::kWatch});
  joblink::ClientMessage message;
  message.mutable_get_status();
  return caller.ask_now(message).status();
}

TEST(MessageJson, TheStatusThatAllShareIsTheMachinesAtAnyTime) {
  HttpRig rig;
  SocketClient client(rig, "/kinebus/v1/socket");
  Connection& wire = rig.connect();
  const auto expect_told = [&](const char* when) {
    const std::vector<Heard> frames = client.say(R"({"request_id":4294967295,"get_status":{}})");
    ASSERT_EQ(frames.size(), 1U) << when;
    const json of_request = rig.ask(wire, HttpRig::head("GET", "/kinebus/v1/get_status") + "\r\n").json();
    const json expected = by_protobuf(asked_by_the_job_link(rig));
    EXPECT_EQ(frames[0].json(), (json{{"reply", {{"request_id", 4294967295U}, {"status", expected}}}}))
        << when;
    EXPECT_EQ(of_request, expected) << when;
  };
  expect_told("off");
  ASSERT_TRUE(rig.link.machine.make_ready());
  rig.pump();
  expect_told("ready");
  // Of the same turn of the loop, and yet the state behind the command.
  const auto speed = rig.link.machine.gateway->status().feed_override;
  EXPECT_EQ(client.say(R"({"request_id":1,"set_override":{"ratio":0.5}})")[0].json()["reply"].value("error",
                                                                                                    json()),
            json());
  EXPECT_NE(rig.link.machine.gateway->status().feed_override, speed);
  expect_told("slower");
  rig.link.machine.run_for(std::chrono::seconds{1});
  rig.pump();
  expect_told("later");
}

TEST(MessageJson, AStatusIsMadeOncePerTurnHoweverManyAsk) {
  HttpRig rig;
  SocketClient first(rig, "/kinebus/v1/socket"), second(rig, "/kinebus/v1/socket");
  const std::string asks = said(R"({"request_id":1,"get_status":{}})");
  const auto ask = [&](SocketClient& client) {
    ByteSession& session = *client.wire.session;
    session.on_bytes(rig.link.machine.now, {reinterpret_cast<const std::uint8_t*>(asks.data()), asks.size()});
    const std::size_t bytes = session.next_bytes().size();
    session.on_bytes_sent(bytes);
    return bytes;
  };
  rig.link.server->on_time(rig.link.machine.now);
  EXPECT_GT(ask(first), 1000U);
  const std::uint64_t made = rig.link.server->statuses_made();
  EXPECT_GT(ask(second), 1000U);
  EXPECT_GT(ask(first), 1000U);
  EXPECT_EQ(rig.link.server->statuses_made(), made);
  rig.link.server->on_time(rig.link.machine.now);
  EXPECT_GT(ask(second), 1000U);
  EXPECT_EQ(rig.link.server->statuses_made(), made + 1);
}

}  // namespace
}  // namespace kinebus::http
