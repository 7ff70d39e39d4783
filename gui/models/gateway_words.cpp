#include "gui/models/gateway_words.hpp"

#include <QRegularExpression>
#include <array>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {

struct Kind {
  const char* pattern;  ///< of the gateway's words
  const char* words;    ///< %1, %2, ... are what the pattern captures
};

// Numbers and names stay as the gateway writes them: they are those of the job and of the machine file.
constexpr std::array<Kind, 28> kKinds{{
    {"^(.+) is ([-.0-9]+ (?:mm|deg)) outside the workspace$",
     QT_TRANSLATE_NOOP("GatewayWords", "%1 is %2 outside the workspace")},
    {"^(.+): out of reach, the leg is ([-.0-9]+ mm) too short$",
     QT_TRANSLATE_NOOP("GatewayWords", "%1: out of reach, the leg is %2 too short")},
    {"^(.+): would be ([-.0-9]+ (?:mm|deg)) beyond its travel$",
     QT_TRANSLATE_NOOP("GatewayWords", "%1: would be %2 beyond its travel")},
    {"^(.+): the leg leans ([-.0-9]+ deg) too far from its rail$",
     QT_TRANSLATE_NOOP("GatewayWords", "%1: the leg leans %2 too far from its rail")},
    {"^(.+): leg, rail and platform come ([-.0-9]+ deg) too near to each other$",
     QT_TRANSLATE_NOOP("GatewayWords", "%1: leg, rail and platform come %2 too near to each other")},
    {"^too near to a singular pose: condition number (.+)$",
     QT_TRANSLATE_NOOP("GatewayWords", "too near to a singular pose: condition number %1")},
    {"^filament is fed before the job has set a hotend temperature \\(M104\\)$",
     QT_TRANSLATE_NOOP("GatewayWords", "filament is fed before the job has set a hotend temperature (M104)")},
    {"^filament is fed with the hotend at (.+) C; at least (.+) C is needed$",
     QT_TRANSLATE_NOOP("GatewayWords", "filament is fed with the hotend at %1 °C; at least %2 °C is needed")},
    {"^M112 stops the machine here$", QT_TRANSLATE_NOOP("GatewayWords", "M112 stops the machine here")},
    {"^settings are kept in the machine file: M500 to M503 do nothing in a job$",
     QT_TRANSLATE_NOOP("GatewayWords",
                       "settings are kept in the machine file: M500 to M503 do nothing in a job")},
    {"^this machine has no hotend heater$",
     QT_TRANSLATE_NOOP("GatewayWords", "this machine has no heater for the hotend")},
    {"^this machine has no bed heater$",
     QT_TRANSLATE_NOOP("GatewayWords", "this machine has no heater for the bed")},
    {"^hotend temperature (.+) C; allowed are 0 to (.+) C$",
     QT_TRANSLATE_NOOP("GatewayWords", "hotend temperature %1 °C; allowed are 0 to %2 °C")},
    {"^bed temperature (.+) C; allowed are 0 to (.+) C$",
     QT_TRANSLATE_NOOP("GatewayWords", "bed temperature %1 °C; allowed are 0 to %2 °C")},
    {"^a job cannot manage stored jobs: M20 to M32 belong to a session$",
     QT_TRANSLATE_NOOP("GatewayWords", "a job cannot manage stored jobs: M20 to M32 belong to a session")},
    {"^stop by command$", QT_TRANSLATE_NOOP("GatewayWords", "stop by command")},
    {"^homed$", QT_TRANSLATE_NOOP("GatewayWords", "homed")},
    {"^(.+) has control$", QT_TRANSLATE_NOOP("GatewayWords", "%1 has control")},
    {"^nobody has control$", QT_TRANSLATE_NOOP("GatewayWords", "nobody has control")},
    {"^the job (.+) was interrupted: resume to go on with it, or cancel$",
     QT_TRANSLATE_NOOP("GatewayWords", "the job %1 was interrupted: resume to go on with it, or cancel")},
    {"^the job (.+) goes on$", QT_TRANSLATE_NOOP("GatewayWords", "the job %1 goes on")},
    {"^cancelled: positions are known$", QT_TRANSLATE_NOOP("GatewayWords", "cancelled: positions are known")},
    {"^cleared: bring the machine up again$",
     QT_TRANSLATE_NOOP("GatewayWords", "cleared: bring the machine up again")},
    {"^cleared: resume brings the machine up again and goes on with the job$",
     QT_TRANSLATE_NOOP("GatewayWords",
                       "cleared: resume brings the machine up again and goes on with the job")},
    {"^move done$", QT_TRANSLATE_NOOP("GatewayWords", "move done")},
    {"^job done: (.+)$", QT_TRANSLATE_NOOP("GatewayWords", "job done: %1")},
    {"^all lines done: (.+)$", QT_TRANSLATE_NOOP("GatewayWords", "all lines done: %1")},
    {"^the job was not begun: it has (.+) errors$",
     QT_TRANSLATE_NOOP("GatewayWords", "the job was not begun: it has %1 errors")},
}};

}  // namespace

QString GatewayWords::translated(const QString& words) {
  for (const Kind& kind : kKinds) {
    const auto match = QRegularExpression(QString::fromLatin1(kind.pattern)).match(words);
    if (!match.hasMatch()) continue;
    QString text = tr(kind.words);
    for (int i = 1; i <= match.lastCapturedIndex(); ++i) text = text.arg(Format::isolated(match.captured(i)));
    return text;
  }
  return words;
}

}  // namespace kinebus::gui
