"""Results of the identification as sentences, tables, figures and HTML pages."""
