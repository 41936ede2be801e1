"""Where the time goes. Ratios taken in one run mean something; bare times hardly do."""
