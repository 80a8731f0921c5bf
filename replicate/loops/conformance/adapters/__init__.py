"""One adapter for each library; a module's ``library()`` makes it."""
