#pragma once
/// `locograph campaign SCENARIO --runs N`: plans a scenario with many seeds, each in a process of
/// its own, and tells how often and how fast there is a plan (doc/campaigns.md).

#include <locograph/apps/command.h>

namespace locograph {

Command add_campaign(OptionParser& app);

}  // namespace locograph
