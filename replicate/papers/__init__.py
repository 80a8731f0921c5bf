"""The papers that come with the project, one package each."""
