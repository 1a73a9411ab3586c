#include "app/groom/inspect/certain_mends.h"

#include <algorithm>
#include <cmath>

#include "app/files/errors.h"
#include "app/files/length_units.h"
#include "sim/field_text.h"

namespace app {

namespace {

constexpr std::size_t kMinStrands = 20;  // of which the inspector tells a unit

std::string_view nextWord(std::string_view& text) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t end = std::min(text.find(' ', begin), text.size());
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

bool readMove(std::string_view text, Eigen::Vector3f& move) {
  for (int k = 0; k < 3; ++k) {
    const std::size_t comma = std::min(text.find(','), text.size());
    double value = 0;
    if (!sim::parseNumber(text.substr(0, comma), value) || std::abs(value) > 1e7) return false;
    move[k] = static_cast<float>(value);
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return text.empty();
}

// Options that take no value. False for others.
bool readFlag(std::string_view option, GroomMends& mends) {
  if (option == "--drop-bad") mends.drop_bad = true;
  if (option == "--drop-astray") mends.drop_astray = true;
  if (option == "--push-out") mends.push_out = true;
  if (option == "--no-guess") mends = {};
  return option == "--drop-bad" || option == "--drop-astray" || option == "--push-out" || option == "--no-guess";
}

bool readWord(std::string_view option, std::string_view value, GroomMends& mends) {
  if (option == "--unit") {
    const auto* const unit = std::ranges::find(kLengthUnits, value, &LengthUnit::name);
    if (unit != kLengthUnits.end()) mends.unit = unit->metres;
    return unit != kLengthUnits.end();
  }
  if (option == "--up") {
    const std::optional<Eigen::Matrix3f> axes = axesOfUp(value);
    if (axes) mends.axes = *axes;
    return axes.has_value();
  }
  if (option == "--reverse") {
    mends.reverse = value == "all" ? Reverse::kAll : value == "found" ? Reverse::kFound : Reverse::kNone;
    return value == "all" || value == "found" || value == "none";
  }
  return option == "--move" && readMove(value, mends.move);
}

bool readNumber(std::string_view option, std::string_view value, GroomMends& mends) {
  double number = 0;
  if (!sim::parseNumber(value, number)) return false;
  const auto single = static_cast<float>(number);
  if (option == "--turn" && std::abs(number) <= 360) {
    mends.axes = turnedAbout(number) * mends.axes;
  } else if (option == "--width-scale" && number > 0) {
    mends.width_scale = single;
  } else if (option == "--scale" && number > 0) {
    mends.scale = single;
  } else if (option == "--width" && number > 0 && number < 1) {
    mends.width = single;
  } else if (option == "--points" && number >= 2 && number <= 1024) {
    mends.points = static_cast<int>(number);
  } else if (option == "--drop-far" && number > 0) {
    mends.drop_far = single;
  } else {
    return false;
  }
  return true;
}

}  // namespace

std::string readMends(std::string_view text, GroomMends& mends) {
  GroomMends out = mends;
  for (std::string_view option = nextWord(text); !option.empty(); option = nextWord(text)) {
    if (readFlag(option, out)) continue;
    const std::string_view value = nextWord(text);
    if (!readWord(option, value, out) && !readNumber(option, value, out))
      return "'" + std::string(option.substr(0, 40)) + " " + std::string(value.substr(0, 40)) +
             "' is no mend; hairmesh-inspect --help lists them";
  }
  mends = out;
  return "";
}

namespace {

bool wished(std::string_view option, std::string_view wishes) {
  return !option.empty() && wishes.find(option) != std::string_view::npos;
}

// What is given is looked at as given: what is found besides goes with it.
GroomHints withGiven(const GroomMends& given, std::string_view wishes, GroomHints hints) {
  if (wished("--unit", wishes)) hints.meters_per_unit = given.unit, hints.unit_given = true;
  // With an axis its turn is in it.
  if (wished("--up", wishes)) hints.axes = given.axes;
  if (wished("--turn", wishes)) hints.turn = hints.axes ? Eigen::Matrix3f(Eigen::Matrix3f::Identity()) : given.axes;
  return hints;
}

}  // namespace

MendReport mendCertain(const GroomHints& hints, const HeadModel* head, const std::string& wishes, Groom& groom) {
  GroomMends given;
  if (const std::string fault = readMends(wishes, given); !fault.empty()) throw InputError("", "mends", fault, "");
  const GroomInspection inspection = inspectGroom(groom, withGiven(given, wishes, hints), head);
  const bool guesses = !wished("--no-guess", wishes), unit_wished = wished("--unit", wishes);
  const double told = hints.meters_per_unit.value_or(1);
  GroomMends mends = inspection.mends;
  readMends(wishes, mends);
  if (guesses) mends.axes = inspection.mends.axes;
  if (!guesses && !unit_wished) mends.unit = told;
  if (!guesses && !wished("--up", wishes)) mends.axes *= toldAxes(hints);
  MendReport report;
  const GroomFinding* const unit = inspection.find("unit");
  report.unit_known = unit_wished || hints.meters_per_unit || (guesses && unit && unit->certain) ||
                      (!unit && groom.strandCount() >= kMinStrands);
  for (const GroomFinding& finding : inspection.findings) {
    const std::string option = finding.mend.substr(0, finding.mend.find(' '));
    report.findings.push_back({finding, (guesses && finding.certain) || wished(option, wishes)});
  }
  report.on_head = inspection.on_head && guesses && !wished("--move", wishes);
  report.unit = mends.unit;
  mendGroom(mends, head, groom);
  return report;
}

std::string mendText(const MendReport& report) {
  std::string text;
  for (const MendedFinding& one : report.findings) {
    const std::string label = one.done ? "mended" : "found";
    const std::string& option = one.finding.mend;
    const std::string mend = option.empty() ? ""
                             : one.done     ? " (" + option + ")"
                                            : " (--mends \"" + option + "\" mends it)";
    text += label + std::string(14 - label.size(), ' ') + one.finding.what + ": " + one.finding.text + mend + "\n";
  }
  return text;
}

}  // namespace app
