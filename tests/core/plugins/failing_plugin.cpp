// A plug-in that registers one type and then fails, with an exception nobody else knows.

#include <locograph/core/plugin.h>

namespace {

struct Unfinished : locograph::Parameter {
  std::string_view tag() const override { return "PARAMS_UNFINISHED"; }
  void read(locograph::FieldReader&) override {}
  void write(locograph::FieldWriter&) const override {}
};

struct OutOfLuck : std::exception {
  const char* what() const noexcept override { return "the moon is in the wrong phase"; }
};

void register_types(locograph::TypeRegistry& types) {
  types.add_parameter<Unfinished>("PARAMS_UNFINISHED");
  throw OutOfLuck();
}

}  // namespace

LOCOGRAPH_PLUGIN(register_types)
