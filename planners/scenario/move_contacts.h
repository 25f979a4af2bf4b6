#pragma once
/// Moves contacts at random on what they lie on: the same task with other places, for campaigns.
///
///     std::mt19937_64 random(7);
///     move_contacts(task.start, world, 0.05, random);  // up to 5 cm
///     for (Stance& goal : task.goals) move_contacts(goal, world, 0.05, random);

#include <locograph/robots/contact.h>
#include <locograph/world/world.h>

#include <random>

namespace locograph {

/// Each contact by itself and evenly: on a surface by up to most_m along each of its two axes, on a
/// bar along the bar. It stays on what it lies on: soles whole, others up to the border; one that
/// reaches beyond the border, or is wider than the surface there, does not get further out.
/// Directions stay as they are, and contacts that lie on nothing stay altogether. Of several
/// surfaces the first counts that the contact's position is within, else the first; then bars. The
/// contacts must be sound; most_m: finite, 0 or more. The same engine gives the same bits.
void move_contacts(Stance& stance, const World& world, double most_m, std::mt19937_64& random);

}  // namespace locograph
