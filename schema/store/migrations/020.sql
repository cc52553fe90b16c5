-- Keys of submissions belong to their owners: submit_key is the owner, the character 31 (a unit separator, which no name has)
-- and the key. Older programs, which look for the key alone, refuse the new file.
UPDATE study SET submit_key = owner || char(31) || submit_key WHERE submit_key IS NOT NULL;
