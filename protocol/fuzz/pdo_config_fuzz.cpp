// Any writes to PDO parameters between PDOs, SYNCs and time: no PDO is longer than 8 bytes, none has a
// restricted identifier, and what is configured loads again as the same.
#include <cstdlib>

#include "protocol/fuzz/dictionary_node.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  DictionaryNode node;
  FrameSource source(data, size);
  LocalTime now{0};
  std::uint8_t kind = 0;
  CanFrame frame;
  while (source.next(kind, frame)) {
    now += std::chrono::milliseconds{kind & 0xF};
    switch (kind >> 6) {
      case 0: {  // a write near the PDO parameters, with the right length
        const std::uint16_t index =
            static_cast<std::uint16_t>(0x1400 + ((frame.data[0] & 3) << 9) + (frame.data[1] & 7));
        const ObjectAddress address{index, static_cast<std::uint8_t>(frame.data[2] & 0xF)};
        if (const int place = find_object(address); place >= 0)
          node.objects.write(address, std::span(frame.data).subspan(4, kNodeTable[place].size()));
        break;
      }
      case 1:
        frame.id = static_cast<std::uint32_t>(0x200 | ((kind & 7) << 8) | 1);
        frame.length = frame.data[7] & 7;
        node.pdos.on_frame(now, frame);
        break;
      case 2:
        node.pdos.on_sync(now, frame.data[0]);
        break;
      default:
        node.pdos.on_time(now);
        node.pdos.trigger(1 + (kind & 3));
        node.pdos.set_operational((kind & 0x20) == 0, now);
    }
    int sent = 0;
    while (const auto pdo = node.pdos.next_frame(now)) {
      if (pdo->length == 0 || pdo->length > 8 || cob_id::is_restricted(pdo->id) || ++sent > kTpdoCount)
        std::abort();
    }
    while (node.pdos.next_problem()) {
    }
  }
  // The parameters as they stand make a valid configuration: the same PDOs are on after loading them anew.
  PdoEngine again(node.objects);
  again.configure();
  for (int i = 1; i <= kTpdoCount; ++i)
    if (again.tpdo_valid(i) != node.pdos.tpdo_valid(i)) std::abort();
  for (int i = 1; i <= kRpdoCount; ++i)
    if (again.rpdo_valid(i) != node.pdos.rpdo_valid(i)) std::abort();
  return 0;
}
