// server/cli/options.hpp: commands and their options, without the headers of CLI11: those cost a
// source eight seconds of compile time. Only options.cpp and program.cpp include them.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace server {

/// An option, flag or positional argument of a command. A handle: a copy is the same option.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required() const;
  /// The word for the value in the help, in place of the variable's type.
  Option type_name(const std::string& word) const;
  /// Shows the present value of the variable in the help.
  Option show_default() const;
  /// Takes one value each time it is given, so that a positional argument may follow.
  Option one_value() const;
  Option excludes(Option other) const;
  Option needs(Option other) const;

  /// Each of these conditions is in the help, and refuses other values with a sentence.
  /// `low` and `high` are allowed. T: int, double or std::size_t, which also says how a value
  /// reads.
  template <typename T>
  Option range(T low, T high) const;
  /// T: const char*, int, unsigned or double.
  template <typename T>
  Option one_of(std::initializer_list<T> values) const;
  Option existing_file() const;
  Option existing_folder() const;
  /// `complaint` returns the sentence that refuses a value; an empty one allows it. `words`
  /// describe the condition in the help.
  Option check(std::function<std::string(const std::string&)> complaint,
               const std::string& words = "") const;

 private:
  CLI::Option* option_;
};

/// A command of the program, or the program itself. A handle: a copy is the same command.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  /// `names`: "--long,-s" for an option, "NAME" for a positional argument. `variable` must live
  /// until the arguments have been parsed. T: a type that options.cpp lists at its end. Refuses
  /// negative values of unsigned types, and floating-point numbers that are not finite.
  template <typename T>
  Option add_option(const std::string& names, T& variable, const std::string& help) const;
  /// `take` gets the value once it has passed its checks.
  Option add_option_function(const std::string& names,
                             const std::function<void(const std::string&)>& take,
                             const std::string& help) const;
  Option add_flag(const std::string& names, bool& variable, const std::string& help) const;
  /// An option or flag added before. Throws std::exception if there is none.
  Option get_option(const std::string& name) const;

  Command add_subcommand(const std::string& name, const std::string& help) const;
  /// Refuses arguments that do not name exactly one subcommand.
  void require_subcommand() const;
  /// The last part of the help.
  void footer(const std::string& text) const;
  /// `run` is called if the arguments name this command and are good.
  void callback(std::function<void()> run) const;

 private:
  CLI::App* app_;
};

}  // namespace server
