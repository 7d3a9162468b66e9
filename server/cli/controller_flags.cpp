// server/cli/controller_flags.cpp: the options, and the catalogue that they describe.
#include "server/cli/controller_flags.hpp"

#include "server/external/registration.hpp"

namespace server {

void ControllerFlags::add_to(Command command, const std::string& help) {
  command.add_option("--controller", given, help).type_name("NAME|[NAME=]COMMAND").one_value();
  command
      .add_option(
          "--answer-limit", answer_limit, "Longest wait for a controller of your own; 0: for ever")
      .type_name("SECONDS")
      .range(0.0, 86'400.0)
      .show_default();
  command
      .add_option("--think-time",
                  think_time,
                  "While a controller of your own thinks, the world pauses (pause), or its answer "
                  "acts as much later as it took (measured), or a number of ticks later")
      .type_name("pause|measured|TICKS")
      .show_default();
}

std::shared_ptr<const algo::ControllerCatalogue> ControllerFlags::catalogue() const {
  std::vector<external::Registration> own;
  const external::ThinkTime think = external::think_time_from_text(think_time);
  for (const std::string& text : given) {
    if (!external::is_command(text)) continue;
    own.push_back(external::registration_from_text(text));
    own.back().answer_limit = answer_limit;
    own.back().think = think;
  }
  if (own.empty()) return nullptr;
  return std::make_shared<const algo::ControllerCatalogue>(external::catalogue_with(own));
}

std::optional<std::string> ControllerFlags::named() const {
  std::optional<std::string> name;
  for (const std::string& text : given) {
    if (!external::is_command(text)) name = text;
  }
  return name;
}

std::optional<std::string> ControllerFlags::chosen() const {
  if (auto name = named()) return name;
  if (given.empty()) return std::nullopt;
  return external::registration_from_text(given.front()).name;
}

}  // namespace server
