-- Part of the statements of this folder: the condition $by that check was given or the log says, else the tag of that name.
coalesce([c."value" FOR c IN d.conditions IF c."condition" = $by][1], d.tags[$by])
