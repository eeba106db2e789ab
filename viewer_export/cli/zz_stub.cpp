#include "viewer_export/cli/commands.h"
namespace reemit::cli { void add_export_command(CLI::App&, Action&) {} }
