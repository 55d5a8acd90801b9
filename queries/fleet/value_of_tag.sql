-- Part of the statements of this folder: the value of $by that the manifest gives a drive, else that which check was given or the log says.
coalesce(d.tags[$by], [c."value" FOR c IN d.conditions IF c."condition" = $by][1])
